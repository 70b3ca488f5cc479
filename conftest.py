"""Settings for all tests."""

import gc
import os

import pytest

# Tests run in more processes than there are cores: threads of their own would be in each other's way.
# NumPy asks when it is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from aidl_lang.explaining import trials
from tests import interrupts as interrupts
from tests.amount import pytest_collection_modifyitems as pytest_collection_modifyitems

# What a message says hangs on the program here, and not on how busy the machine is.
trials.SECONDS, trials.LONGEST = 10.0, 20.0


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """One more than there are cores: some tests wait for a browser, a server or a clock."""
    return (os.cpu_count() or 1) + 1


def pytest_collection_finish() -> None:
    """What was loaded by now stays: it is not searched for garbage again and again."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(50_000, 20, 20)
