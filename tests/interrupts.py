"""Interrupts reach what tests start: a shell lets what runs beside others ignore them, and processes inherit
that.
"""

import signal

signal.signal(signal.SIGINT, signal.default_int_handler)
