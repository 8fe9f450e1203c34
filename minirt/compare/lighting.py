"""The light of another ray tracer: how bright its terms are, by least squares, under a guess about their form.

Light is a sum of terms, each times its factor. `minirt.compare.table` has the names and values of a guess.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from minirt.compare.changed_shapes import Mask
from minirt.compare.geometry import Floats, Seen, arriving, cosines, highlights, reach
from minirt.compare.sky import found_sky
from minirt.compare.table import OURS, SOFT_FADING, Guess
from minirt.scene import Scene

LEVEL = 1 / 255
DARKEST, BRIGHTEST = 3 * LEVEL, 252 * LEVEL  # levels that are neither clamped nor rounded to nothing
WORST = 20 * LEVEL  # a larger error counts as this one
PRICE = 0.02 * LEVEL  # of a difference from this program
PRIOR = 1e-6  # how much a factor that the picture does not tell is drawn to that of this program
HELD = 1e9  # times the prior, for a factor that is fixed
SLACK, FADING_SLACK = 0.08, 0.5  # by which a factor may differ from 1 without a word; that of lamps that fade
SQUARED_SLACK = 0.02  # of lamps whose squared brightness is a factor, too
STEADY = 0.1  # a difference within a shape that is larger counts as this one
MOST_ROWS = 4000  # of least squares
MOST_SPECKS = 0.6  # of the pixels of shapes: more dark ones are no acne
AMBIENT, OBJECT, SPECULAR, MIRROR, FADED, LAMPS = range(6)  # places of terms of light; lamps are the last ones
MIRROR_ROUNDS = 3  # of the light in mirrors, which needs factors
ROUNDS = 4  # of least squares, each without what the one before did not explain


class Fit(NamedTuple):
    """Colours of pixels under a guess, and how well they fit."""

    score: float  # mean error plus the price of the guess
    error: Floats  # (n,) of the worst channel, from 0 to 1
    shown: Floats  # (n, 3) levels under the guess, from 0 to 1
    factors: Floats  # of all terms of light
    diffuse: Floats  # (lamps,) factors; 1 in this program
    sky: Floats  # the background, as `sky.background` has it
    odd: int  # factors, of ambient light and of lamps, that are not those of this program


def numbers(colour: Any) -> Floats:
    """A colour from 0 to 1."""
    return np.array(colour, float) / 255


def columns(scene: Scene, seen: Seen, guess: Guess, factors: Floats) -> Floats:
    """Return the terms of the light at each point, (n, 3, LAMPS + lamps), from 0 to 1 as are levels: what the point
    would show for a factor 1 of each term.

    `factors` add up the light of what a mirror at the point would show, which makes the term MIRROR: its factor is the
    share that all surfaces reflect. `scene` is without mirrors of its own.
    """
    shapes, lamps = scene.shapes, scene.lights
    black = [(0, 0, 0)]  # the last row, of the owner -1: the background has no terms
    colours = numbers([getattr(shape, "colour", (255, 255, 255)) for shape in shapes] + black)[seen.owner]
    colours = colours ** {"object ignored": 0, "object squared": 2}.get(guess["colours"], 1)
    bright = lamp_colours(scene, guess)
    normal, cosine = cosines(seen, guess)
    arrived = arriving(seen, guess)
    light = cosine * arrived
    distance = np.where(np.isfinite(seen.distance), seen.distance / reach(scene), 1.0)  # parallel light does not fade
    light = light / np.maximum(distance, 1e-3) ** exponent(guess)
    if guess["fading"] in SOFT_FADING:
        light /= 1 + SOFT_FADING[guess["fading"]] * np.where(np.isfinite(seen.distance), seen.distance, 0.0)
    terms = np.zeros((*colours.shape, LAMPS + len(lamps)))
    has_ambient = guess["ambient_in_shadow"] | (light > 0).any(axis=0)
    terms[..., AMBIENT] = ambient_light(scene, colours, bright, guess["ambient"]) * has_ambient[:, None]
    if guess["ambient"] == "light plus object":
        terms[..., OBJECT] = colours
    for i, tone in enumerate(bright):
        terms[..., LAMPS + i] = colours * tone * light[i][:, None]
        if guess["fading"] == "linear":
            terms[..., FADED] -= terms[..., LAMPS + i] * distance[i][:, None]
    shining = (cosine > 0) * arrived  # highlights do not fade with the distance
    if guess["specular"]:
        form, power, of_object = guess["specular"]
        tones = np.einsum("ln,lc->nc", highlights(seen, normal, form, power) * shining, bright)
        terms[..., SPECULAR] = tones * (colours if of_object else 1)
    for number, shape in enumerate(shapes):
        if material := getattr(shape, "specular", None):
            form = "blinn" if material.blinn else "phong"
            own = material.share * highlights(seen, normal, form, material.exponent) * shining * (seen.owner == number)
            terms[..., SPECULAR] += np.einsum("ln,lc->nc", own, bright)
    if seen.mirror is not None:
        terms[..., MIRROR] = added(columns(scene, seen.mirror, guess, factors), factors)
    return terms


def lamp_colours(scene: Scene, guess: Guess) -> list[Floats]:
    """Return the light of each lamp, (3,), in its colour or in white, times its brightness or the square of that."""
    is_white = guess["colours"] == "light ignored"
    colours = [numbers((255, 255, 255) if is_white else lamp.colour) for lamp in scene.lights]
    brightnesses = [lamp.brightness ** guess["brightness"] for lamp in scene.lights]
    return [colour * brightness for colour, brightness in zip(colours, brightnesses, strict=True)]


def ambient_light(scene: Scene, colours: Floats, bright: list[Floats], form: str) -> Floats:
    """Return the ambient term, (n, 3), on objects of some colours, (n, 3), among lamps of `bright` colours, in one of
    the forms that the parameter "ambient" has; 0 for others."""
    tint = numbers(scene.ambient.colour) * scene.ambient.brightness if scene.ambient else np.zeros(3)
    grey = np.full(3, scene.ambient.brightness if scene.ambient else 0.0)
    plain, lamps_light = np.ones_like(colours), np.sum([np.zeros(3), *bright], axis=0)
    forms = {"object x light": colours * tint, "light alone": plain * tint, "light plus object": plain * tint,
             "object alone": colours * grey, "of the lamps": colours * lamps_light,
             "in light of the lamps": colours * tint * lamps_light}  # fmt: skip
    result: Floats = forms.get(form, 0 * colours)
    return result


def added(terms: Floats, factors: Floats) -> Floats:
    """Return the sums of terms, (n, 3, k), with factors; in one product of a matrix, which is several times faster."""
    return (terms.reshape(-1, len(factors)) @ factors).reshape(terms.shape[:-1])


def exponent(guess: Guess) -> int:
    """The power of the distance by which light fades; 0 for other forms."""
    return 0 if isinstance(guess["fading"], str) else int(guess["fading"])


def unevenness(seen: Seen, colours: Floats, guess: Guess) -> Floats:
    """Return how far each pixel is from what a shape of one colour would show, squared, (n,).

    That is, for each shape and channel of `colours`, (n, 3), the linear function of the lamps' light that fits best.
    """
    _, cosine = cosines(seen, guess)
    light = (cosine * arriving(seen, guess)).sum(axis=0)
    region = seen.owner + 1  # 0 is the background
    count = np.maximum(np.bincount(region), 1)
    light_off = light - (np.bincount(region, light) / count)[region]  # from the mean of the shape
    variance = np.bincount(region, light_off * light_off) + 1e-6  # not 0 in even light
    residual = np.zeros(len(region))
    for channel in colours.T:
        level_off = channel - (np.bincount(region, channel) / count)[region]
        slope = np.bincount(region, level_off * light_off) / variance
        residual += (level_off - slope[region] * light_off) ** 2
    return residual


def fit(scene: Scene, seen: Seen, colours: Floats, guess: Guess, judged: Mask, fixed: str = "") -> Fit:
    """Find the factors of the terms of light by which a guess explains colours, (n, 3) from 0 to 1, best, and return
    the levels that follow.

    `judged` are the pixels that count; the factor of the `fixed` term, ambient, diffuse or specular, is that of this
    program.
    """
    theirs = colours[:, ::-1] if guess["colours"] == "swapped" else colours
    own, beyond = judged & (seen.owner >= 0), judged & (seen.owner < 0)
    factors = usual = usual_factors(scene, guess)
    for _ in range(MIRROR_ROUNDS if seen.mirror else 1):
        terms = columns(scene, seen, guess, factors)
        factors = least_squares(terms[own], theirs[own], guess["gamma"], usual, fixed)
    sky = found_sky(scene, seen.direction[beyond], theirs[beyond], guess["background"])
    shown = drawn(terms, seen, guess, factors, sky)
    error = np.abs(shown - theirs).max(axis=-1)
    if guess["acne"]:  # dark specks show no more than the first terms: they count as explained where they are few
        dark = np.abs(drawn(terms[..., :SPECULAR], seen, guess, factors[:SPECULAR], sky) - theirs).max(axis=-1)
        specks = (dark < error - WORST) & own
        if specks.sum() < MOST_SPECKS * own.sum():
            error = np.where(specks, dark, error)
    diffuse = factors[LAMPS:] * reach(scene) ** exponent(guess)
    slack = SLACK if guess["brightness"] == 1 else SQUARED_SLACK
    if exponent(guess):
        slack = FADING_SLACK
    odd = [differs(float(factors[AMBIENT])), differs(middle(diffuse), slack)].count(True)
    differences = [guess[name] != value for name, value in OURS.items()].count(True)
    score = float(np.minimum(error[judged], WORST).mean()) if judged.any() else WORST
    return Fit(score + PRICE * (differences + odd), error, shown, factors, diffuse, sky, odd)


def usual_factors(scene: Scene, guess: Guess) -> Floats:
    """The factors of this program: one, but for what it does not add."""
    factors = np.ones(LAMPS + len(scene.lights))
    factors[[OBJECT, MIRROR, FADED]] = 0.0
    factors[SPECULAR] = float(has_highlights(scene) and not guess["specular"])
    return factors


def has_highlights(scene: Scene) -> bool:
    """Whether a scene asks for highlights."""
    return any(getattr(shape, "specular", None) for shape in scene.shapes)


def least_squares(terms: Floats, theirs: Floats, gamma: float, usual: Floats, fixed: str) -> Floats:
    """Return the factors (k,), 0 or more, of terms of light, (n, 3, k), whose sum is nearest to the levels `theirs`,
    (n, 3), of light^(1/gamma).

    Levels that are nearly black or white do not count, nor, from the second round on, do outliers: those off by more
    than twice the median. Factors that the levels do not tell are near the `usual` ones, as is that of the `fixed`
    term.
    """
    usable = (theirs > DARKEST) & (theirs < BRIGHTEST)
    slope = gamma * theirs[usable] ** (gamma - 1)  # of light over levels: errors are to be those of levels
    rows, values = terms[usable] / slope[:, None], theirs[usable] ** gamma / slope
    step = len(values) // MOST_ROWS + 1
    rows, values = rows[::step], values[::step]
    weight = PRIOR * max(len(values), 1) * np.eye(len(usual))
    terms_of: dict[str, Any] = {"ambient": AMBIENT, "diffuse": slice(LAMPS, None), "specular": SPECULAR}
    held = terms_of.get(fixed, slice(0))
    weight[held, held] *= HELD
    factors, kept, before = usual, np.ones(len(values), bool), np.zeros(len(values), bool)
    for _ in range(ROUNDS):
        if (kept == before).all():
            break
        before = kept
        chosen, aims = rows[kept], values[kept]
        found = np.linalg.solve(chosen.T @ chosen + weight, chosen.T @ aims + weight @ usual)
        factors = np.maximum(found, 0).astype(np.float64)
        off = np.abs(rows @ factors - values)
        is_lit = rows[:, FADED:] @ factors[FADED:] >= 0  # as far as lamps reach that fade
        if lit := np.count_nonzero(is_lit):
            median = np.partition(off[is_lit], lit // 2)[lit // 2]
            kept = (off < max(2 * median, 3 * LEVEL)) & is_lit
    return factors


def drawn(terms: Floats, seen: Seen, guess: Guess, factors: Floats, sky: Floats) -> Floats:
    """Return the levels of pixels, (n, 3) from 0 to 1, in the order of the scene's colours."""
    shown = added(terms, factors)
    if guess["fading"] == "linear":  # to no less than 0
        shown -= np.minimum(added(terms, factors * (np.arange(len(factors)) >= FADED)), 0)
    shown = shown_levels(shown, guess)
    beyond = seen.owner < 0
    shown[beyond] = np.clip(sky[0] + seen.direction[beyond, 1:2] * sky[1], 0, 1)
    return shown


def middle(factors: Floats) -> float:
    """The median of the factors of lamps; 1 without any."""
    return float(np.median(factors)) if len(factors) else 1.0


def differs(factor: float, slack: float = SLACK) -> bool:
    """Whether a factor is not the one of this program."""
    return abs(factor - 1) > slack


def shown_levels(light: Floats, guess: Guess) -> Floats:
    """Return the levels, from 0 to 1, by which light is shown."""
    if guess["overflow"] == "wrapped":
        light = light % (256 * LEVEL)
    result: Floats = np.clip(light, 0, 1) ** (1 / guess["gamma"])
    return result
