"""The browser of the tests of the preview, for the built site."""

from server.tests.preview.conftest import browser

__all__ = ["browser"]
