"""Settings for all tests."""

import os

# Tests run in as many processes as there are cores: threads of their own would be in each other's way.
# NumPy asks when it is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from aidl_lang.explaining import trials
from tests import amount as amount  # how many examples are tried
from tests import interrupts as interrupts

# What a message says hangs on the program here, and not on how busy the machine is.
trials.SECONDS, trials.LONGEST = 10.0, 20.0
