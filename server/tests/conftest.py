"""Settings for these tests run by themselves: those of all tests."""

from tests import conftest as conftest
