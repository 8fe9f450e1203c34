"""Style: the colours of the panel, and its spaces. Text has a contrast of at least 4.5 with what it lies on (WCAG 2).

Grey that is neutral beside any picture, and the gold by which the window marks what is selected.
"""

from __future__ import annotations

from slimgui import imgui

from minirt.viewer.display.overlay import MESSAGE_COLOUR

Rgba = tuple[float, float, float, float]
Col = imgui.Col
TEXT, FAINT_TEXT = 0xF0F0F0, 0xA8A8AC
GROUND, LIST, POPUP = 0x1C1C1E, 0x141416, 0x242427
BOX, BOX_UNDER_POINTER, BOX_PRESSED = 0x333337, 0x424247, 0x55503C
CHOSEN, CHOSEN_UNDER_POINTER = 0x5C4A1C, 0x6B5722
LINE, GRIP = 0x48484D, 0x6A6A70
GOLD = MESSAGE_COLOUR
LEGIBLE = 4.5  # contrast of text, at least
FADED = 0.65  # of what is switched off: its opacity
COLOURS = {
    TEXT: [Col.TEXT, Col.INPUT_TEXT_CURSOR],
    FAINT_TEXT: [Col.TEXT_DISABLED],
    GROUND: [Col.WINDOW_BG, Col.CHILD_BG, Col.SCROLLBAR_BG, Col.TAB, Col.TAB_DIMMED],
    POPUP: [Col.POPUP_BG],
    BOX: [Col.FRAME_BG, Col.BUTTON, Col.TAB_SELECTED, Col.TAB_DIMMED_SELECTED, Col.CHECKBOX_SELECTED_BG],
    BOX_UNDER_POINTER: [Col.FRAME_BG_HOVERED, Col.BUTTON_HOVERED, Col.TAB_HOVERED],
    BOX_PRESSED: [Col.FRAME_BG_ACTIVE, Col.BUTTON_ACTIVE],
    CHOSEN: [Col.HEADER, Col.TEXT_SELECTED_BG, Col.PLOT_HISTOGRAM],
    CHOSEN_UNDER_POINTER: [Col.HEADER_HOVERED, Col.HEADER_ACTIVE],
    LINE: [Col.BORDER, Col.SEPARATOR],
    GRIP: [Col.SCROLLBAR_GRAB, Col.SCROLLBAR_GRAB_HOVERED, Col.SCROLLBAR_GRAB_ACTIVE],
    GOLD: [Col.CHECK_MARK, Col.NAV_CURSOR, Col.TAB_SELECTED_OVERLINE, Col.TAB_DIMMED_SELECTED_OVERLINE],
}


def rgba(colour: int) -> Rgba:
    """Red, green, blue and opacity, from 0 to 1, of 0xRRGGBB."""
    red, green, blue = colour.to_bytes(3)
    return red / 255, green / 255, blue / 255, 1.0


def set_colours() -> None:
    """Give all widgets of the context the colours of the panel."""
    style = imgui.get_style()
    style.disabled_alpha = FADED
    for each in Col.__members__.values():
        if each != Col.COUNT:
            style.colors[each] = rgba(LINE)
    for colour, widgets in COLOURS.items():
        for each in widgets:
            style.colors[each] = rgba(colour)


def set_spaces(size: int) -> None:
    """Set the spaces between and within widgets for text of a size in pixels."""
    style = imgui.get_style()
    style.window_padding = style.item_spacing = 0.4 * size, 0.25 * size
    style.frame_padding = style.item_inner_spacing = 0.22 * size, 0.15 * size
    style.indent_spacing, style.scrollbar_size, style.grab_min_size = 0.5 * size, 0.7 * size, 0.7 * size
