"""Lines with one error each: the line, the column and the message, or a part of it."""

# ruff: noqa: RUF001 - refused lines have characters that look like others

from __future__ import annotations

from minirt.element import fields_of
from minirt.shapes import Sphere
from tests.scene.examples import PLANE, SPHERE

Case = tuple[str, int, str]  # a line, the column of its error, a part of the message

IDENTIFIERS: list[Case] = [
    ("Sp 0,0,20 5 255,0,0", 1, "unknown element 'Sp', did you mean 'sp'?"),
    ("a 0.2 255,255,255", 1, "unknown element 'a', did you mean 'A'?"),
    ("sphere 0,0,20 5 255,0,0", 1, "did you mean 'sp'?"),
    ("  xx 0,0,0", 3, "unknown element 'xx'"),
    ("sp: 0,0,20 5 255,0,0", 1, "unknown element 'sp:', did you mean 'sp'?"),
    ("ｓｐ 0,0,20 5 255,0,0", 1, "unknown element 'ｓｐ'"),
    ("sр 0,0,20 5 255,0,0", 1, "unknown element 'sр'"),  # the second letter is Cyrillic
    ("sp0,0,20 5 255,0,0", 3, "a blank is missing after 'sp'"),
    ("0,0,20 5 255,0,0", 1, "a line begins with one of R, A, bg, C, c, L, l, dl, sl"),
    ("// a comment", 1, "a comment begins with '#', got '//'"),
    ("sp 0,0,20 5 255,0,0 // red", 21, "a comment begins with '#', got '//'"),
]

COUNTS: list[Case] = [
    ("sp", 3, "sphere centre and diameter and colour are missing: expected 'sp x,y,z diameter R,G,B'"),
    ("sp 0,0,20 5", 12, "sphere colour is missing"),
    ("sp 0,0,20 5 255,0,0 7", 21, "sphere has no further field '7': expected 'sp x,y,z diameter R,G,B'"),
    ("sp 0,0,20 5 255,0,0 ,", 20, "no blanks may stand around a comma"),
    (f"{SPHERE} {PLANE}", 25, "sphere has no further field 'pl' (one element a line)"),
    (
        "L 0,0,20 0.5 roll:5",
        14,
        "light has no attribute 'roll': it belongs to camera, further camera, shapes with an axis or a normal",
    ),
    (
        "tr 0,0,0 1,0,0 0,1,0 9,9,9 roll:5",
        28,
        "triangle has no attribute 'roll': it belongs to camera, further camera, shapes with an",
    ),
    ("bo 0,0,0 0,1,0 1,1,1 9,9,9 axis:1,0,0", 28, "box has no attribute 'axis': it belongs to spheres and meshes"),
    ("sp 0,0,20 5 255,0,0 uv:1,1,0,0,4,7", 34, "sphere uv must be su,sv[,ou[,ov[,degrees]]]"),
    ("sp 0,0,20 5 255,0,0 rol:5", 21, "unknown attribute 'rol', did you mean 'roll'?"),
    ("sp roll:5 0,0,20 5 255,0,0", 3, "sphere centre and diameter and colour are missing"),
]

VECTORS: list[Case] = [
    ("sp 0,0,20 5 255,0,0 axis:0,0,0", 26, "sphere axis must not be 0,0,0: it points nowhere"),
    ("sp 0,20 5 255,0,0", 4, "sphere centre must be x,y,z, three numbers with commas between them, got '0,20'"),
    ("sp 0,,20 5 255,0,0", 6, "sphere centre y must be a number, got ''"),
    ("sp 0,0,20 5 255,0,0 mirror: 0.3", 21, "no blank may stand behind 'mirror:'"),
    ("sp 0,0,20 5 255,0,0 mirror: specular:1,9", 28, "sphere mirror share must be a number, got ''"),
    ("sp (0,0,20) 5 255,0,0", 4, "sphere centre x must be a number, got '(0'"),
    ("sp 0, 0, 20 5 255,0,0", 5, "no blanks may stand around a comma"),
    ("sp 0,0,20 5 255,0,0,", 21, "sphere colour must be R,G,B"),
    ("sp 0,0,20 5 ,255,0,0", 12, "no blanks may stand around a comma"),
    ("sp 0,0,20 5,255,0,0", 10, "sphere diameter and colour are missing"),
    ("sp 0，0，20 5 255,0,0", 4, "must be x,y,z"),
]

NOT_NUMBERS = [
    *("nan", "NaN", "-nan", "inf", "+inf", "-Infinity", "INF", "0x14", "0b1", "0o7", "0x1p3", "1p3", "1d5", "1j"),
    *("2..0", "0.2.3", "1.5.", ".5.", "..5", ".", "-", "+", "-.", "--1", "++1", "+-1", "-+1", "20-", "2-0", "2+0"),
    *("20a", "20f", "20F", "20L", "20px", "5cm", "a", "e", "e5", ".e1", "-e1", "1e", "1e+", "1E-", "1e1.5", "1ee5"),
    *("1e5e5", "1e--5", '"0.2"', "0,2", "1,000", "1_000", "$5", "5%", "1/2", "2*3", "(5)", "true", "None", "null"),
    *("x", "5;", ";5", "*", "?", "~", "=5", "5°", "٣", "２", "५", "²", "½", "Ⅴ", "五", "𝟓", "−5", "–5", "1٫5"),
]

NUMBERS: list[Case] = [
    *((f"sp 0,0,20 {word} 255,0,0", 11, f"sphere diameter must be a number, got '{word}'") for word in NOT_NUMBERS),
    ("sp 0,0,20 1e400 255,0,0", 11, "must be a number that a float64 can hold, got '1e400'"),
    ("sp 0,1e400,20 5 255,0,0", 6, "sphere centre y must be a number that a float64 can hold"),
    ("sp 0,−1,20 5 255,0,0", 6, "got '−1': U+2212 MINUS SIGN is not ASCII"),
    ("L 0,0,0 0,2 255,255,255", 9, "light brightness must be a number, got '0,2'"),
]

RANGES: list[Case] = [
    ("L 0,0,0 -0.1 255,0,0", 9, "light brightness must be in [0, 1], got -0.1"),
    ("sp 0,0,20 5 256,0,0", 13, "sphere colour R must be in [0, 255], got 256"),
    (f"sp 0,0,20 5 {'9' * 300},0,0", 13, "sphere colour R must be in [0, 255], got 1e+300"),
    (f"sp 0,0,20 5 {'9' * 301},0,0", 13, "sphere colour R must be a whole number, got 301 characters: '999"),
    (f"R {'9' * 300} 480", 3, "resolution width must be in [1, 16384], got 1e+300"),
    ("sp 0,0,20 5 255,0,0,255", 21, "sphere colour must be R,G,B"),
    ("sp 0,0,20 5 #ff0000", 13, "sphere colour must be R,G,B, got '#ff0000': '#' begins a comment"),
    ("sp 0,0,20 5 127.5,0,0", 13, "sphere colour R must be a whole number, got '127.5'"),
    ("sp 0,0,20 5 ２５５,0,0", 13, "U+FF12 FULLWIDTH DIGIT TWO is not ASCII"),
    ("sp 0,0,20 0 255,0,0", 11, "sphere diameter must be > 0, got 0"),
    ("sp 0,0,20 1e16 255,0,0", 11, "sphere diameter must be in [1e-50, 1e+15], got 1e+16"),
    ("pl 0,0,0 0,0,0 255,0,0", 10, "plane normal must not be 0,0,0: it points nowhere"),
    ("sp 1.1e15,0,0 5 255,0,0", 4, "sphere centre x must be in [-1e+15, 1e+15], got 1100000000000000"),
    ("R 480 16385", 7, "resolution height must be in [1, 16384], got 16385"),
    ("sp 0,0 5,5 2 255,0,0", 4, "sphere centre must be x,y,z"),  # with a word too many, so that the next may be right
]

BLANKS: list[Case] = [
    ("sp\xa00,0,20 5 255,0,0", 3, "only spaces and tabs separate fields, got U+00A0 NO-BREAK SPACE"),
    ("sp 0,0,20 5\u200b 255,0,0", 12, "U+200B ZERO WIDTH SPACE"),
    ("\ufeffsp 0,0,20 5 255,0,0", 1, "U+FEFF"),
    ("\f", 1, "got U+000C"),
    ("sp 0,0,20 5 255,0,0\x85sp 0,0,20 5 255,0,0", 20, "got U+0085"),
    ("sp 0,0,20 5 255,0,0\u2028sp 0,0,20 5 255,0,0", 20, "U+2028 LINE SEPARATOR"),
    ("sp 0,0,20\r5 255,0,0", 10, "a carriage return ends a line only together with a line feed"),
    ("# a comment\rsp 0,0,20 5 255,0,0", 12, "a carriage return"),
]


# Attributes, lights and backgrounds, with the whole messages.

COLUMN = len(SPHERE) + 2  # column of the first attribute behind a sphere
NUMBER = "must be a number, got"
OWN = f"sphere has {', '.join(field.keyword for field in fields_of(Sphere) if field.keyed)}"
MISSING = "cannot be read: no such file or directory"


def on_sphere(*cases: Case) -> list[Case]:
    """Return cases with their attributes behind a sphere; columns are counted from the first attribute."""
    return [(f"{SPHERE} {words}", COLUMN + column, message) for words, column, message in cases]


SHAPES: list[Case] = on_sphere(
    ("specular:2,30", 9, "sphere specular share must be in [0, 1], got 2"),
    ("specular:0.5,0.99", 13, "sphere specular exponent must be in [1, 1000000], got 0.99"),
    ("specular:0.5", 9, "sphere specular must be share,exponent[,blinn], got '0.5'"),
    ("specular:0.5,30,phong", 16, "sphere specular blinn must be the word 'blinn' or be left out, got 'phong'"),
    ("specular", 0, "sphere specular needs a value: 'specular:share,exponent[,blinn]', such as 'specular:0.5,30'"),
    ("glow=0.5", 0, "an attribute is written with a colon: 'glow:0.5'"),
    ("miror", 0, "sphere has no further field 'miror', did you mean 'mirror:share[,range]'?"),
    ("mirror:0.5 0.6", 11, "only attributes 'name:value' follow an attribute, got '0.6'"),
    ("ref:1.5,1,x", 10, f"sphere glass fade {NUMBER} 'x'"),
    ("fresnel fresnel:1", 8, "sphere has 'fresnel' twice"),
    ("pat:2 checker", 6, "sphere has 'checker' twice"),
    ("texture:", 8, "sphere texture must be the name of a picture file, without tabs, quotes and #, got ''"),
    ("texture:no.png", 8, f"sphere texture must be a picture file, got 'no.png': {MISSING}"),
    ("tx:no,1.png", 3, f"sphere texture must be a picture file, got 'no,1.png': {MISSING}"),
    ("txm:a#b.png", 4, f"sphere texture must be a picture file, got 'a': {MISSING}"),
    ("bum:,2", 4, "sphere bump file must be the name of a picture file, without tabs, commas, quotes and #, got ''"),
    ("Mirror:0.5", 0, "unknown attribute 'Mirror', did you mean 'mirror'?"),
    ("zzz:0.5", 0, f"unknown attribute 'zzz': {OWN}"),
    ("fade:5", 0, "sphere has no attribute 'reach': it belongs to light, further light, spot light"),
)

LIGHTS: list[Case] = [
    ("l 0,0,0 1 mirror:0.5", 11, "further light has no attribute 'mirror': it belongs to shapes"),
    ("dl 0,-1,0", 10, "parallel light brightness is missing: expected 'dl dx,dy,dz brightness [R,G,B] [size:degrees]'"),
    ("L 0,0,0 1 rim:0.5", 11, "light has no attribute 'rim': it belongs to spot light"),
    ("l 0,0,0 1 attenuation:9", 11, "unknown attribute 'attenuation': further light has reach, size"),
]

BACKGROUNDS: list[Case] = [
    ("bg", 3, "background paint is missing: expected 'bg R,G,B or file'"),
    ("bg no.png", 4, f"background paint must be a picture file, got 'no.png': {MISSING}"),
    ("bg 1,2,3 mirror:1", 10, "background has no attribute 'mirror': it belongs to shapes"),
    ("bg #102030", 4, "background paint must be R,G,B, got '#102030': '#' begins a comment"),
]
