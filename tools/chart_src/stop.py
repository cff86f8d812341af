"""Signals that ask to end: the first one raises Stopped, later ones do nothing, as results are being written."""
import contextlib
import signal

NUMBERS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
_waiting = {"held": False, "number": None}


class Stopped(KeyboardInterrupt):
    """A signal asks to end."""

    def __init__(self, number):
        super().__init__()
        self.number = number


def ignore():
    for number in NUMBERS:
        signal.signal(number, signal.SIG_IGN)


def _stop(number, _):
    ignore()
    if not _waiting["held"]:
        raise Stopped(number)
    _waiting["number"] = number


def listen():
    for number in NUMBERS:
        signal.signal(number, _stop)


@contextlib.contextmanager
def held():
    """Stopped is raised at the end of the block, not in the middle of it."""
    _waiting["held"] = True
    try:
        yield
    finally:
        _waiting["held"] = False
        number, _waiting["number"] = _waiting["number"], None
        if number is not None:
            raise Stopped(number)
