"""Records are dataclasses: whatever `dataclasses` says of a class, a record of the same fields says."""

import pickle
from dataclasses import FrozenInstanceError, asdict, dataclass, field, fields, replace

import pytest

from aidl_lang.common.records import record


@record()
class Point:
    x: float
    y: float = 0.0


@record()
class Named(Point):
    """A subclass with defaults of each kind."""

    name: str = "p"
    tags: list[str] = field(default_factory=list, compare=False)
    secret: str = field(default="s", repr=False)
    length: int = field(init=False, default=7)
    cache: dict[str, int] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.cache["made"] = 1


@dataclass(frozen=True)
class PlainPoint:
    x: float
    y: float = 0.0


@record(slots=True, kw_only=True)
class Small:
    a: int
    b: int = 2


@record(frozen=False)
class Box:
    items: list[int] = field(default_factory=list)


@record(eq=False)
class Thing:
    x: int


def test_arguments_are_those_of_the_fields():
    assert (Point(1).x, Point(1).y, Point(1, y=2).y) == (1, 0.0, 2)
    assert (Small(a=1).a, Small(b=5, a=1).b) == (1, 5)
    named = Named(1, 2, "q", ["t"])
    assert (named.name, named.tags, named.secret, named.length, named.cache) == (
        "q",
        ["t"],
        "s",
        7,
        {"made": 1},
    )


@pytest.mark.parametrize(
    ("make", "missing"),
    [
        (lambda: Point(), "missing 1 required positional argument: 'x'"),
        (lambda: Point(1, 2, 3), "takes from 2 to 3 positional arguments but 4 were given"),
        (lambda: Point(1, z=2), "got an unexpected keyword argument 'z'"),
        (lambda: Small(1), "takes 1 positional argument but 2 were given"),
        (lambda: Named(1, length=3), "got an unexpected keyword argument 'length'"),
    ],
)
def test_wrong_arguments_are_refused_like_those_of_a_function(make, missing):
    with pytest.raises(TypeError, match=missing):
        make()


def test_defaults_that_are_made_are_made_for_each():
    one, other = Box(), Box()
    one.items.append(1)
    assert other.items == []


def test_records_are_equal_by_the_fields_that_are_compared():
    assert Point(1, 2) == Point(1, 2)
    assert Point(1, 2) != Point(1, 3)
    assert Named(1, tags=["a"]) == Named(1, tags=["b"])
    assert Named(1) != Point(1)  # another class
    assert Point(1) != (1, 0.0)
    assert Thing(1) != Thing(1)


def test_frozen_records_are_hashed_as_dataclasses_are():
    assert hash(Point(1, 2)) == hash(PlainPoint(1, 2))
    assert len({Point(1), Point(1), Point(2)}) == 2
    assert len({Thing(1), Thing(1)}) == 2
    with pytest.raises(TypeError, match="unhashable"):
        hash(Box())


def test_they_show_the_fields_that_are_shown():
    assert repr(Point(1)) == repr(PlainPoint(1)).removeprefix("Plain")
    assert repr(Named(1)) == "Named(x=1, y=0.0, name='p', tags=[], length=7, cache={'made': 1})"
    box = Box()
    box.items.append(box)
    assert repr(box) == "Box(items=[...])"


def test_what_a_class_says_itself_stands():
    @record()
    class Own:
        x: int

        def __init__(self) -> None:
            self.x = 3

        def __repr__(self) -> str:
            return "own"

        def __eq__(self, other: object) -> bool:
            return True

        def __hash__(self) -> int:
            return 5

    assert (repr(Own()), Own() == 1, hash(Own()), Own().x) == ("own", True, 5, 3)


def test_the_tools_for_dataclasses_know_them():
    assert [f.name for f in fields(Named)][:3] == ["x", "y", "name"]
    assert replace(Point(1, 2), y=5) == Point(1, 5)
    assert asdict(Point(1, 2)) == {"x": 1, "y": 2}
    match Point(1, 2):
        case Point(x, y):
            assert (x, y) == (1, 2)


@pytest.mark.parametrize("value", [Point(1, 2), Small(a=3)])
def test_they_are_sent_between_processes(value):
    assert pickle.loads(pickle.dumps(value)) == value


def test_slots_leave_no_room_for_more():
    with pytest.raises(AttributeError):
        Small(a=1).c = 2


def test_the_type_checker_alone_guards_their_fields():
    """What is gained by that is said in the module; a dataclass would raise."""
    point = Point(1)
    point.x = 2
    assert point == Point(2)
    with pytest.raises(FrozenInstanceError):
        PlainPoint(1).x = 2
