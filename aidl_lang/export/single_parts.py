"""Parts each by itself: a job for every part that differs from the others."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from aidl_lang.export import ON_SHEETS, ExportError, Job
from aidl_lang.export.cut_list import Item
from aidl_lang.geometry.parts import Motion, drawn, parts_of


def jobs_of_parts(job: Job) -> Iterator[tuple[Item, Job]]:
    """Yields each item of the cut list with the job for one of its parts: flat, with its lower left corner at
    the origin. Raises ExportError for what explains the whole, and if there is no part.
    """
    options = job.options
    is_on_sheets = options.sheet is not None
    if options.dimension or (options.show and not (is_on_sheets and options.show.issubset(ON_SHEETS))):
        option = "--dimension" if options.dimension else f"--show {','.join(sorted(options.show))}"
        raise ExportError(
            "E0926",
            f"`{option}` explains the whole drawing and has no place in files of single parts",
            "write it to a file of its own",
        )
    items = job.cut_list.items
    if not items:
        raise ExportError(
            "E0926", "there is no part to write", "only a `solid` is cut; a `drawing` is engraved"
        )
    alone = replace(options, cut=options.for_cutter, sheet=None, nest=None, kerf=0.0, show=frozenset())
    found = {part.body.path: part for part in parts_of(job.model.root, job.drawing)[0]}
    for item in items:
        part = found[item.part.body.path]
        part = part.moved(Motion(0.0, -part.box[0], -part.box[1]))
        yield item, replace(job, drawing=drawn(job.drawing, [part]), options=alone, is_flat=True)
