"""The few kinds of marks that overlays are made of. Coordinates in mm, y upwards."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from aidl_lang.export.numbers import fixed
from aidl_lang.geometry.curves import Vec
from aidl_lang.geometry.evaluate import Bounds

FONT = "DejaVu Sans, Verdana, Arial, sans-serif"
CHARACTER = 0.6
"""Mean width of a character of this font, relative to its size."""

_NOT_XML = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def clean(text: str) -> str:
    """Without the characters that XML cannot hold."""
    return _NOT_XML.sub("\ufffd", text)


@dataclass(frozen=True)
class Text:
    """A line of text; `anchor` is start, middle or end, `at` lies on its baseline."""

    at: Vec
    text: str
    size: float
    color: str
    anchor: str = "start"
    bold: bool = False
    halo: bool = True

    @property
    def box(self) -> Bounds:
        width = CHARACTER * self.size * len(self.text)
        left = self.at[0] - {"start": 0.0, "middle": 0.5, "end": 1.0}[self.anchor] * width
        return left, self.at[1] - 0.25 * self.size, left + width, self.at[1] + 0.8 * self.size

    def element(self, svg: Any) -> Any:
        looks = {"font_size": fixed(self.size), "font_family": FONT, "fill": self.color}
        if self.anchor != "start":
            looks["text_anchor"] = self.anchor
        if self.bold:
            looks["font_weight"] = "bold"
        at = (fixed(self.at[0]), fixed(-self.at[1]))
        text = svg.text.Text(clean(self.text), insert=at, **looks, debug=False)
        if not self.halo:
            return text
        # The halo is a text of its own below: not every renderer knows `paint-order`.
        looks |= {"fill": "#ffffff", "stroke": "#ffffff", "stroke_width": fixed(0.22 * self.size)}
        halo = svg.text.Text(clean(self.text), insert=at, stroke_linejoin="round", **looks, debug=False)
        halo["aria-hidden"] = "true"
        both = svg.container.Group(debug=False)
        both.add(halo)
        both.add(text)
        return both


@dataclass(frozen=True)
class Dot:
    """A filled circle with a white rim."""

    at: Vec
    radius: float
    color: str

    def element(self, svg: Any) -> Any:
        return svg.shapes.Circle(
            center=(fixed(self.at[0]), fixed(-self.at[1])),
            r=fixed(self.radius),
            fill=self.color,
            stroke="#ffffff",
            stroke_width=fixed(0.3 * self.radius),
            debug=False,
        )


@dataclass(frozen=True)
class Frame:
    """A thin rectangle without a fill, dashed if a dash length is given."""

    box: Bounds
    color: str
    width: float
    dash: float = 0.0

    def element(self, svg: Any) -> Any:
        left, bottom, right, top = self.box
        extra = {"stroke_dasharray": f"{fixed(self.dash)} {fixed(0.7 * self.dash)}"} if self.dash else {}
        return svg.shapes.Rect(
            insert=(fixed(left), fixed(-top)),
            size=(fixed(right - left), fixed(top - bottom)),
            fill="none",
            stroke=self.color,
            stroke_width=fixed(self.width),
            debug=False,
            **extra,
        )


Mark = Text | Dot | Frame
