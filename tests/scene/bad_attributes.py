"""Lines with one wrong attribute, light or background each: the line, the column and the whole message."""

from __future__ import annotations

from minirt.element import fields_of
from minirt.shapes import Sphere
from tests.scene.examples import SPHERE

Case = tuple[str, int, str]  # a line, the column of its error, the message

COLUMN = len(SPHERE) + 2  # column of the first attribute behind a sphere
NUMBER = "must be a number, got"
OWN = f"sphere has {', '.join(field.keys[0] for field in fields_of(Sphere) if field.keyed)}"
MISSING = "cannot be read: no such file or directory"


def on_sphere(*cases: Case) -> list[Case]:
    """Return cases with their attributes behind a sphere; columns are counted from the first attribute."""
    return [(f"{SPHERE} {words}", COLUMN + column, message) for words, column, message in cases]


SHAPES: list[Case] = on_sphere(
    ("specular:2,30", 9, "sphere specular share must be in [0, 1], got 2"),
    ("specular:-0.1,30", 9, "sphere specular share must be in [0, 1], got -0.1"),
    ("specular:0.5,0.99", 13, "sphere specular exponent must be in [1, 1000000], got 0.99"),
    ("specular:0.5", 9, "sphere specular must be share,exponent[,blinn], got '0.5'"),
    ("specular:", 9, f"sphere specular share {NUMBER} ''"),
    ("specular:0.5,", 13, f"sphere specular exponent {NUMBER} ''"),
    ("specular:0.5,30,phong", 16, "sphere specular blinn must be the word 'blinn' or be left out, got 'phong'"),
    ("specular:0.5,30,blinn,1", 22, "sphere specular must be share,exponent[,blinn], got '0.5,30,blinn,1'"),
    ("specular:nan,30", 9, f"sphere specular share {NUMBER} 'nan'"),
    ("spc:0.5,1e400", 8, "sphere specular exponent must be a number that a float64 can hold, got '1e400'"),
    ("specular", 0, "sphere has no further field 'specular', did you mean 'specular:share,exponent[,blinn]'?"),
    ("miror", 0, "sphere has no further field 'miror', did you mean 'mirror:share[,fade]'?"),
    ("m_wood", 0, "sphere has no further field 'm_wood', did you mean 'wood:size[,R,G,B[,octaves[,height]]]'?"),
    ("m_gold", 0, "sphere has no further field 'm_gold': expected 'sp x,y,z diameter R,G,B'"),
    ("mirror:1.5", 7, "sphere mirror share must be in [0, 1], got 1.5"),
    ("mir:1.5", 4, "sphere mirror share must be in [0, 1], got 1.5"),
    ("mirror:0.5,-1", 11, "sphere mirror fade must be in [0, 1e+15], got -1"),
    ("mirror:0.5,1,2", 13, "sphere mirror must be share[,fade], got '0.5,1,2'"),
    ("mirror:0.5 0.6", 11, "only attributes 'name:value' follow an attribute, got '0.6'"),
    ("mirror:0.5 sp", 11, "only attributes 'name:value' follow an attribute, got 'sp'"),
    ("glass:0.99", 6, "sphere glass ior must be in [1, 10], got 0.99"),
    ("glass:1.5,1.1", 10, "sphere glass share must be in [0, 1], got 1.1"),
    ("ref:1.5,1,x", 10, f"sphere glass fade {NUMBER} 'x'"),
    ("ref:1.5,1,1,1", 12, "sphere glass must be ior[,share[,fade]], got '1.5,1,1,1'"),
    ("tint:1,2", 5, "sphere tint must be R,G,B[,distance], got '1,2'"),
    ("tint:1,2,256", 9, "sphere tint colour B must be in [0, 255], got 256"),
    ("tint:1,2,3,0", 11, "sphere tint distance must be > 0, got 0"),
    ("tint:1,2,3,4,5", 13, "sphere tint must be R,G,B[,distance], got '1,2,3,4,5'"),
    ("fresnel:2", 8, "sphere fresnel must be in [0, 1], got 2"),
    ("fresnel:yes", 8, f"sphere fresnel {NUMBER} 'yes'"),
    ("fresnel fresnel:1", 8, "sphere has 'fresnel' twice"),
    ("glow:1.01", 5, "sphere glow must be in [0, 1], got 1.01"),
    ("glow", 0, "sphere has no further field 'glow', did you mean 'glow:share'?"),
    ("checker:0", 8, "sphere checker size must be > 0, got 0"),
    ("checker:", 8, f"sphere checker size {NUMBER} ''"),
    ("checker:1,2", 8, "sphere checker must be size[,R,G,B], got '1,2'"),
    ("checker:1,2,3", 8, "sphere checker must be size[,R,G,B], got '1,2,3'"),
    ("checker:1,255,256,0", 14, "sphere checker colour G must be in [0, 255], got 256"),
    ("checker:1,255,0,0.5", 16, "sphere checker colour B must be a whole number, got '0.5'"),
    ("checker:1,1,2,3,4", 16, "sphere checker must be size[,R,G,B], got '1,1,2,3,4'"),
    ("checker checker:2", 8, "sphere has 'checker' twice"),
    ("pat:2 checker", 6, "sphere has 'checker' twice"),
    ("spc:0,1 specular:0,1", 8, "sphere has 'specular' twice"),
    ("marble", 0, "sphere has no further field 'marble', did you mean 'marble:size[,R,G,B[,octaves[,height]]]'?"),
    ("marble:0", 7, "sphere marble size must be > 0, got 0"),
    ("wood:1,2", 5, "sphere wood must be size[,R,G,B[,octaves[,height]]], got '1,2'"),
    ("clouds:1,1,2,300", 13, "sphere clouds colour B must be in [0, 255], got 300"),
    ("clouds:1,1,2,3,13", 15, "sphere clouds octaves must be in [1, 12], got 13"),
    ("wood:1,1,2,3,6,11", 15, "sphere wood height must be in [-10, 10], got 11"),
    ("wood:1,1,2,3,6,1,1", 17, "sphere wood must be size[,R,G,B[,octaves[,height]]], got '1,1,2,3,6,1,1'"),
    ("texture:", 8, "sphere texture must be the name of a picture file, without blanks and #, got ''"),
    ("texture:no.png", 8, f"sphere texture must be a picture file, got 'no.png': {MISSING}"),
    ("tx:no,1.png", 3, f"sphere texture must be a picture file, got 'no,1.png': {MISSING}"),
    ("txm:a#b.png", 4, f"sphere texture must be a picture file, got 'a': {MISSING}"),
    ("bump:no.png,2", 5, f"sphere bump must be a picture file, got 'no.png': {MISSING}"),
    ("bump:no.png,11", 12, "sphere bump strength must be in [-10, 10], got 11"),
    ("bum:,2", 4, "sphere bump file must be the name of a picture file, without blanks, commas and #, got ''"),
    ("normal:no.png", 7, f"sphere normal map must be a picture file, got 'no.png': {MISSING}"),
    ("nm:no.png", 3, f"sphere normal map must be a picture file, got 'no.png': {MISSING}"),
    ("speculr:0.5,30", 0, "unknown attribute 'speculr', did you mean 'specular'?"),
    ("mirorr:0.5", 0, "unknown attribute 'mirorr', did you mean 'mirror'?"),
    ("Mirror:0.5", 0, "unknown attribute 'Mirror', did you mean 'mirror'?"),
    ("normal_map:a.png", 0, "unknown attribute 'normal_map', did you mean 'normal'?"),
    ("zzz:0.5", 0, f"unknown attribute 'zzz': {OWN}"),
    ("refl:0.5", 0, "unknown attribute 'refl', did you mean 'mirror'?"),
    ("refr:0.9:1.5", 0, "unknown attribute 'refr', did you mean 'glass'?"),
    ("shininess:200", 0, "unknown attribute 'shininess', did you mean 'specular'?"),
    ("xpm:earth.xpm", 0, "unknown attribute 'xpm', did you mean 'texture'?"),
    ("bump_strength:0.3", 0, "unknown attribute 'bump_strength', did you mean 'bump'?"),
    ("fade:5", 0, "sphere has no attribute 'fade': it belongs to light, further light, spot light"),
    ("checkers", 0, "sphere has no further field 'checkers', did you mean 'checker:size[,R,G,B]'?"),
    ("chessboard", 0, "sphere has no further field 'chessboard', did you mean 'checker:size[,R,G,B]'?"),
)

LIGHTS: list[Case] = [
    ("l 0,0,0 1 mirror:0.5", 11, "further light has no attribute 'mirror': it belongs to shapes"),
    (
        "l 0,0,0 1 checker",
        11,
        "further light colour must be R,G,B, three numbers with commas between them, got 'checker'",
    ),
    ("l 0,0,0 1 1,2,3 fade:0", 22, "further light fade must be > 0, got 0"),
    ("l 0,0,0 1 size:0", 16, "further light size must be > 0, got 0"),
    ("l 0,0,0 1 size:wide", 16, f"further light size {NUMBER} 'wide'"),
    ("sl 0,0,0 0,-1,0 40 1 size:-2", 27, "spot light size must be > 0, got -2"),
    ("dl 0,-1,0 1 size:91", 18, "parallel light size must be in [0, 90], got 91"),
    ("dl 0,-1,0 1 size:-1", 18, "parallel light size must be in [0, 90], got -1"),
    ("l 0,0,0 1 fade:-1", 16, "further light fade must be > 0, got -1"),
    (
        "dl 0,-1,0 1 fade:5",
        13,
        "parallel light has no attribute 'fade': it belongs to light, further light, spot light",
    ),
    ("dl 0,0,0 1", 4, "parallel light direction must not be 0,0,0: it points nowhere (--lenient takes 0,-1,0)"),
    ("dl 0,-2,0 1", 6, "parallel light direction y must be in [-1, 1], got -2"),
    ("dl 0,-1,0 1.5", 11, "parallel light brightness must be in [0, 1], got 1.5"),
    ("dl 0,-1,0", 10, "parallel light brightness is missing: expected 'dl dx,dy,dz brightness [R,G,B] [size:degrees]'"),
    ("sl 0,0,0 0,-1,0 181 1", 17, "spot light angle must be in [0, 180], got 181"),
    ("sl 0,0,0 0,-1,0 -1 1", 17, "spot light angle must be in [0, 180], got -1"),
    ("sl 0,0,0 0,-1,0 40 1 rim:2", 26, "spot light rim must be in [0, 1], got 2"),
    (
        "sl 0,0,0 0,-1,0 40",
        19,
        "spot light brightness is missing: expected "
        "'sl x,y,z dx,dy,dz angle brightness [R,G,B] [rim:ratio] [fade:distance] [size:diameter]'",
    ),
    ("L 0,0,0 1 rim:0.5", 11, "light has no attribute 'rim': it belongs to spot light"),
    ("l 0,0,0 1 attenuation:9", 11, "unknown attribute 'attenuation', did you mean 'fade'?"),
    (
        "dl 0,-1,0 1 1,2,3 soft",
        19,
        "parallel light has no further field 'soft': expected 'dl dx,dy,dz brightness [R,G,B] [size:degrees]'",
    ),
    ("dl 0,-1,0 1 soft:1", 13, "unknown attribute 'soft': parallel light has size"),
    ("R 640 480 mirror:1", 11, "resolution has no attribute 'mirror': it belongs to shapes"),
]

BACKGROUNDS: list[Case] = [
    ("bg", 3, "background paint is missing: expected 'bg R,G,B or file'"),
    ("bg 1,2", 4, "background paint must be R,G,B, three numbers with commas between them, got '1,2'"),
    ("bg 1,2,256", 8, "background paint B must be in [0, 255], got 256"),
    ("bg no.png", 4, f"background paint must be a picture file, got 'no.png': {MISSING}"),
    ("bg 255", 4, f"background paint must be a picture file, got '255': {MISSING}"),
    ("bg 1,2,3 4", 10, "background has no further field '4': expected 'bg R,G,B or file'"),
    ("bg 1,2,3 mirror:1", 10, "background has no attribute 'mirror': it belongs to shapes"),
    ("bg #102030", 4, "background paint must be R,G,B, got '#102030': '#' begins a comment"),
]
