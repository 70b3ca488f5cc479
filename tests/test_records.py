"""Records are dataclasses: whatever `dataclasses` says of a class, a record of the same fields says."""

import pickle
from dataclasses import field

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


@record(slots=True, kw_only=True)
class Small:
    a: int
    b: int = 2


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


@pytest.mark.parametrize("value", [Point(1, 2), Small(a=3)])
def test_they_are_sent_between_processes(value):
    assert pickle.loads(pickle.dumps(value)) == value
