"""What is being done, on stderr: one line that moves on a terminal, elsewhere a line a stage."""
import sys


class Progress:
    def __init__(self, quiet):
        self.quiet, self.terminal, self.what = quiet, sys.stderr.isatty(), ""

    def show(self, text):
        print(f"\r\033[K{text[:100]}", end="", file=sys.stderr, flush=True)

    def stage(self, what):
        self.what = what
        if not self.quiet:
            if self.terminal:
                self.show(what)
            else:
                print(what, file=sys.stderr, flush=True)

    def detail(self, what):
        if not self.quiet and self.terminal:
            self.show(f"{self.what}: {what}")

    def end(self):
        if not self.quiet and self.terminal:
            self.show("")
