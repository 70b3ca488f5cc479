"""Whether gears mesh, read off their teeth: how far apart they stand, and that a tooth meets a gap."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from tests.checker.functions import dot, minus
from tests.checker.tree import Geo, Vec

if TYPE_CHECKING:
    from tests.checker.evaluate import Evaluator


def meshes(ev: Evaluator, a: Geo, b: Geo, backlash: Any = None) -> list[float]:
    if a.type != "gear":
        a, b = b, a
    room = 0.0 if backlash is None else ev.number(backlash).value
    alike = [abs(_told(ev, a, n) - _told(ev, b, n)) for n in ("module", "pressure_angle")]
    return alike + {"gear": _gears, "internal_gear": _inside, "rack": _on_rack}[b.type](ev, a, b, room)


def _told(ev: Evaluator, gear: Geo, name: str) -> float:
    return float(ev.member(gear, name).value)


def _pitch_radius(ev: Evaluator, gear: Geo) -> float:
    return _told(ev, gear, "teeth") * _told(ev, gear, "module") / 2


def _first_tooth(ev: Evaluator, gear: Geo) -> float:
    """The direction of tooth 0 from the centre, in degrees."""
    tip: Vec = ev.member(gear.parts["tooth[0]"].parts["tip"], "midpoint").xy
    return _direction(minus(tip, _center(ev, gear)))


def _center(ev: Evaluator, gear: Geo) -> Vec:
    center: Vec = ev.member(gear.parts["root[0]"], "center").xy
    return center


def _direction(v: Vec) -> float:
    return math.degrees(math.atan2(v[1], v[0]))


def _off_gap(ev: Evaluator, gear: Geo, teeth: float) -> float:
    """How far, along the pitch line, a number of pitches is from half a pitch."""
    return abs(teeth % 1 - 0.5) * math.pi * _told(ev, gear, "module")


def _gears(ev: Evaluator, a: Geo, b: Geo, room: float) -> list[float]:
    way = minus(_center(ev, b), _center(ev, a))
    seen = _direction(way)
    phase = (seen - _first_tooth(ev, a)) * _told(ev, a, "teeth") / 360
    phase += (seen + 180 - _first_tooth(ev, b)) * _told(ev, b, "teeth") / 360
    apart = (_pitch_radius(ev, a) + _pitch_radius(ev, b)) * _spread(ev, a, b) + room
    return [abs(math.hypot(*way) - apart), _off_gap(ev, a, phase)]


def _spread(ev: Evaluator, a: Geo, b: Geo) -> float:
    """Profile shifts move gears apart: the cosines of the pressure and the working angle, by bisection."""
    pressure = math.radians(_told(ev, b, "pressure_angle"))
    shift = _told(ev, a, "profile_shift") + _told(ev, b, "profile_shift")
    involute = math.tan(pressure) - pressure
    involute += 2 * shift * math.tan(pressure) / (_told(ev, a, "teeth") + _told(ev, b, "teeth"))
    low, high = 0.0, math.radians(80)
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if math.tan(middle) - middle < involute else (low, middle)
    return math.cos(pressure) / math.cos(low)


def _inside(ev: Evaluator, a: Geo, b: Geo, room: float) -> list[float]:
    """A gear in a ring: `space`, what the ring leaves free, is a gear, and its tooth is the ring's gap."""
    space = b.parts["space"]
    way = minus(_center(ev, a), _center(ev, space))
    seen = _direction(way)
    phase = (seen - _first_tooth(ev, a)) * _told(ev, a, "teeth") / 360
    phase -= (seen - _first_tooth(ev, space)) * _told(ev, b, "teeth") / 360
    apart = _pitch_radius(ev, b) - _pitch_radius(ev, a) - room
    return [abs(math.hypot(*way) - apart), _off_gap(ev, a, phase + 0.5)]


def _on_rack(ev: Evaluator, a: Geo, b: Geo, room: float) -> list[float]:
    """A gear above a bar: its pitch circle on the bar's pitch line, one module below the tips."""
    (sx, sy), (ex, ey) = (ev.member(b.parts["tooth[0]"].parts["edges[1]"], e).xy for e in ("start", "end"))
    length = math.hypot(ex - sx, ey - sy)
    along = (ex - sx) / length, (ey - sy) / length
    from_tip = minus(_center(ev, a), ((sx + ex) / 2, (sy + ey) / 2))
    height = along[0] * from_tip[1] - along[1] * from_tip[0]
    pitches = dot(along, from_tip) / (math.pi * _told(ev, a, "module"))
    phase = (_direction(along) - 90 - _first_tooth(ev, a)) * _told(ev, a, "teeth") / 360
    wanted = _pitch_radius(ev, a) - _told(ev, a, "module") + room
    return [abs(height - wanted), _off_gap(ev, a, pitches - phase)]
