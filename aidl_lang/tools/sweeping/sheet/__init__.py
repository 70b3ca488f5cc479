"""The contact sheet of a sweep: a small picture of each variant, its params and what is wrong with it."""

from __future__ import annotations

from collections.abc import Sequence

from aidl_lang.tools.sweeping.rows import Columns, Row


def contact_sheet(suffix: str, title: str, columns: Columns, rows: Sequence[Row]) -> bytes:
    """Returns a contact sheet in the format of a suffix: `.html`, `.pdf` or `.png`."""
    if suffix == ".html":
        from aidl_lang.tools.sweeping.sheet.page import page

        return page(title, columns, rows)
    if suffix == ".pdf":
        from aidl_lang.tools.sweeping.sheet.pdf import pdf

        return pdf(title, rows)
    from aidl_lang.tools.sweeping.sheet.png import png

    return png(title, rows)
