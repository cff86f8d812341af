#!/usr/bin/env python3
"""The object of path_kernel.cu emits no host code of the headers that it shares with the CPU.

    path_kernel_symbols_test.py OBJECT

Under nvcc these headers leave out the vector instructions: a weak symbol of theirs could replace,
at link time, the one that the rest of the program was compiled with.
"""
import subprocess
import sys

# What the host side of the file consists of, beside names local to the object.
ALLOWED = ("plumb::DeviceError", "plumb::detail::check_cuda", "plumb::launch_path_kernel",
           "plumb::check_path_kernel", "plumb::(anonymous namespace)::")


def shared_symbols(listing):
    """Weak or global definitions in namespace plumb that do not belong to the file itself."""
    for line in listing.splitlines():
        parts = line.split(maxsplit=2)
        if len(parts) != 3 or parts[1] not in "TWVuBDR":
            continue
        name = parts[2]
        if "plumb::" in name and not any(allowed in name for allowed in ALLOWED):
            yield name


def main(arguments):
    listing = subprocess.run(["nm", "--demangle", arguments[0]], check=True, capture_output=True, text=True).stdout
    if "launch_path_kernel" not in listing:
        print("no symbols found: is this the object of path_kernel.cu?")
        return 1
    found = sorted(set(shared_symbols(listing)))
    for name in found:
        print("host code of a shared header:", name)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
