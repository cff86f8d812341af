#!/usr/bin/env python3
"""The objects of the .cu files emit no host code of the headers that they share with the CPU.

    path_kernel_symbols_test.py OBJECT...

Under nvcc these headers leave out the vector instructions: a weak symbol of theirs could replace,
at link time, the one that the rest of the program was compiled with.
"""
import subprocess
import sys

# What the host side of the file consists of, beside names local to the object.
ALLOWED = ("plumb::DeviceError", "plumb::detail::check_cuda", "plumb::launch_", "plumb::check_path_kernel",
           "plumb::path_kernel_reports", "plumb::wave_kernel_reports", "plumb::ray_kernel_report",
           "plumb::persistent_kernel_report",
           "plumb::(anonymous namespace)::", "plumb::KernelReport", "__device_stub__")


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
    wrong = 0
    for path in arguments:
        listing = subprocess.run(["nm", "--demangle", path], check=True, capture_output=True, text=True).stdout
        if "plumb::launch_" not in listing:
            print(f"{path}: no symbols found: is this the object of a .cu file?")
            wrong += 1
        for name in sorted(set(shared_symbols(listing))):
            print(f"{path}: host code of a shared header: {name}")
            wrong += 1
    return 1 if wrong or not arguments else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
