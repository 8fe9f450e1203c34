"""Names of elements: what their own lines say in a comment, or the comment over a block of lines, or kind and number.

    # arms
    cy 2,0,0 0,1,0 1 2 9,9,9           arms 1
    cy -2,0,0 0,1,0 1 2 9,9,9          arms 2
    sp 0,3,0 1 9,9,9  # head           head

    sp 0,9,0 1 9,9,9                   sphere 2

A block begins below a comment, and ends at a blank line or at another comment.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import chain, islice, takewhile

from minirt.element import Element
from minirt.scene.elements import FURTHER, Lamp
from minirt.scene.lines import line_from
from minirt.scene.pages import Item
from minirt.scene.registry import SPELLINGS
from minirt.scene.scene import MISSING, Scene
from minirt.scene.writer import line_of

LONGEST = 40  # characters of a name: a longer comment is a sentence
LONGEST_BLOCK = 200  # lines on either side of an element in which the comment over its block is looked for
COUNTED_AS = {further: first for first, further in FURTHER.items()}  # kinds that are numbered as one


def element_name(scene: Scene, index: int, translate: Callable[[str], str] = str) -> str:
    """Return the name of `scene.elements[index]` for users; `translate` is given that of its kind."""
    element = scene.elements[index]
    if own := own_name(element):
        return own
    heading, block = named_block(scene, index)
    if not heading:
        return numbered_kind(scene, index, translate)
    named = [each for each in block if not own_name(each)]
    if len(named) == 1:
        return heading
    return f"{heading} {next(number for number, each in enumerate(named, 1) if each is element)}"


def numbered_kind(scene: Scene, index: int, translate: Callable[[str], str] = str) -> str:
    """Return the kind of an element and its number among those of this kind; what a scene has once has no number."""
    element = scene.elements[index]
    kind = COUNTED_AS.get(type(element), type(element))
    title = translate(kind.title)
    if is_setting(element) and len(scene.of(kind)) == 1:
        return title
    page, place = page_of(scene, index)
    elements, alike = (scene.pages[page].of(sort) for sort in (Element, kind))
    number = sum(len(each.of(kind)) for each in scene.pages[:page]) + place + 1
    if len(alike) < len(elements):
        number -= sum(not issubclass(type(each), kind) for each in elements[: place + 1])
    return f"{title} {number}"


def own_name(element: Element) -> str:
    """Return the name that the comment on the line of an element gives it; '' without one."""
    _, sign, comment = element.source.partition("#")
    return name_in(sign + comment)


def renamed(element: Element, name: str) -> Element:
    """Return an element with another name of its own, or none: the comment on its line; all else of the line stays."""
    source = line_of(element)
    line = line_from(1, source)
    name = " ".join("".join(each if each.isprintable() else " " for each in name).split())
    text, comment = line.text[: line.end], line.text[line.end :]
    if not name or not comment:
        text = text.rstrip(" \t")
    if name:
        text += f"# {name}" if comment else f" # {name}"
    before, _, after = source.partition(line.text)
    return element.replace(source=before + text + after)


def named_block(scene: Scene, index: int) -> tuple[str, list[Element]]:
    """Return the name that the comment over the block of an element gives to it, and the elements of the block.

    There is no name where the block holds settings of the scene: such a comment is about the file.
    """
    above, below = around(scene, index)
    heading = name_in(next((each for each in above if isinstance(each, str)), ""))
    if not heading:
        return "", []
    items = (*reversed(list(takewhile(is_element, above))), scene.elements[index], *takewhile(is_element, below))
    block = [each for each in items if isinstance(each, Element)]
    return (heading, block) if not any(map(is_setting, block)) else ("", [])


def is_setting(element: Element) -> bool:
    """Whether a scene has an element once, such as its camera."""
    return type(element).once and not isinstance(element, Lamp)


def is_element(item: Item) -> bool:
    return not isinstance(item, str)


def around(scene: Scene, index: int) -> tuple[Sequence[Item], Sequence[Item]]:
    """Return the items above an element, from it upwards, and those below it, as far as a block may reach."""
    page, place = page_of(scene, index)
    items, at = scene.pages[page].items, place
    if len(scene.pages[page].of(Element)) < len(items):
        at = next(islice((number for number, item in enumerate(items) if is_element(item)), place, None))
    before = (each.items[: -LONGEST_BLOCK - 1 : -1] for each in reversed(scene.pages[:page]))
    after = (each.items[:LONGEST_BLOCK] for each in scene.pages[page + 1 :])
    above = chain(items[max(0, at - LONGEST_BLOCK) : at][::-1], chain.from_iterable(before))
    below = chain(items[at + 1 : at + 1 + LONGEST_BLOCK], chain.from_iterable(after))
    return tuple(islice(above, LONGEST_BLOCK)), tuple(islice(below, LONGEST_BLOCK))


def page_of(scene: Scene, index: int) -> tuple[int, int]:
    """Return the number of the page that holds an element, and the element's index among those of the page."""
    page = 0
    while index >= (length := len(scene.pages[page].of(Element))):
        index, page = index - length, page + 1
    return page, index


def name_in(comment: str) -> str:
    """Return the name in a comment; '' in a sentence, in a line that was taken out, and in anything else."""
    text = comment.strip()
    name = text.strip("#-=* \t")
    first, _, rest = name.partition(" ")
    is_line = first in SPELLINGS and rest.lstrip("-.")[:1].isdigit()
    is_name = text.startswith("#") and len(name) <= LONGEST and not is_line and not text.startswith(MISSING)
    return name if is_name else ""
