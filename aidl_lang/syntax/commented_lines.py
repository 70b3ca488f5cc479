"""The lines of a program that is printed, and the comments among them."""

from __future__ import annotations

from aidl_lang.common.records import record
from aidl_lang.syntax import ast
from aidl_lang.syntax.expression_printer import WIDTH


@record(frozen=False)
class Line:
    """A line of output; `comment` follows it, aligned with those of the lines around it."""

    text: str
    comment: str = ""


class CommentedLines:
    """Lines that are added one after the other, and the comments of a module that are still to be printed."""

    def __init__(self, module: ast.Module) -> None:
        self.source = module.source.text
        self.comments = module.comments
        self.next_comment = 0
        self.lines: list[Line] = []

    def text(self) -> str:
        """Returns all lines, the trailing comments of neighbouring lines in one column."""
        out: list[str] = []
        run: list[Line] = []
        for line in [*self.lines, Line("")]:
            if line.comment:
                run.append(line)
                continue
            column = max((len(one.text) for one in run if len(one.text) <= WIDTH), default=0)
            out += [f"{one.text.ljust(column)}  {one.comment}" for one in run]
            run = []
            out.append(line.text)
        out.pop()
        return "".join(line.rstrip() + "\n" for line in out)

    def _comments_before(self, offset: int, place: int, indent: int, first: bool) -> tuple[int, bool]:
        """Prints the comments up to an offset on lines of their own."""
        while (comment := self._peek(offset)) is not None:
            self._blank_line(place, comment.span.start, first)
            first = False
            self.lines.append(Line(" " * indent + comment.text.rstrip()))
            self.next_comment += 1
            place = comment.span.end
        return place, first

    def _peek(self, before: int) -> ast.Comment | None:
        """Returns the next comment, if it begins before an offset."""
        if self.next_comment < len(self.comments) and self.comments[self.next_comment].span.start < before:
            return self.comments[self.next_comment]
        return None

    def _blank_line(self, place: int, start: int, first: bool) -> None:
        if not first and self.source.count("\n", place, start) > 1:
            self.lines.append(Line(""))

    def _comments_inside(self, statement: ast.Statement, indent: int, mark: int) -> None:
        """Moves comments in the middle of a statement in front of it."""
        moved = []
        while (comment := self._peek(statement.span.end)) is not None:
            moved.append(Line(" " * indent + comment.text.rstrip()))
            self.next_comment += 1
        self.lines[mark:mark] = moved

    def _trailing_comment(self, place: int) -> int:
        """Puts a comment that follows on the same line behind the last line. Returns the offset to go on
        from.
        """
        comment = self._peek(len(self.source) + 1)
        if comment is None or comment.span.start < place or "\n" in comment.text:
            return place
        between = self.source[place : comment.span.start]
        if between.strip(" \t,;") or self.lines[-1].comment:
            return place
        self.lines[-1].comment = comment.text.rstrip()
        self.next_comment += 1
        return comment.span.end

    def _has_comment(self, start: int, end: int) -> bool:
        comment = self._peek(end)
        return comment is not None and comment.span.end > start
