#!/usr/bin/env python3
"""The objects of accel/sah/isa/ share no function with the rest of the program.

    isa_symbols_test.py OBJECT...

Each is compiled for an instruction set of its own. A weak function in one of them (an inline one that
was not inlined) could replace, at link time, the one that all others call: on a processor without
that instruction set the program would end. So avx2.cpp, avx512.cpp and portable.cpp define their
kernels and what is local to them, and portable.cpp holds no AVX instruction.
"""
import pathlib
import re
import subprocess
import sys

KERNELS = {name: f"plumb::{name}_kernels(plumb::TriangleTest)" for name in ("portable", "avx2", "avx512")}
AVX = re.compile(r"^\s*[0-9a-f]+:\s+(?:v[a-z0-9]+|k[a-z]+[bwdq])\s|%[yz]mm|%k[0-7]")


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def shared_symbols(listing, kernel):
    """Definitions in the output of nm that other objects see, beside the kernel."""
    for line in listing.splitlines():
        parts = line.split(maxsplit=2)
        if len(parts) == 3 and (parts[1].isupper() or parts[1] in "uvw") and parts[2] != kernel:
            yield parts[2]


def avx_lines(assembly):
    return [line.strip() for line in assembly.splitlines() if AVX.search(line)]


def errors_of(path):
    name = next((n for n in KERNELS if pathlib.Path(path).name.startswith(n + ".")), None)
    if name is None:
        return []
    listing = output_of("nm", "--demangle", "--defined-only", path)
    if KERNELS[name] not in listing:
        return [f"{name}: no kernels found in {path}"]
    errors = [f"{name}: visible to other objects: {symbol}"
              for symbol in sorted(set(shared_symbols(listing, KERNELS[name])))]
    found = avx_lines(output_of("objdump", "--disassemble", "--no-show-raw-insn", path))
    if name == "portable":
        errors += [f"{name}: an AVX instruction: {line}" for line in found[:5]]
    elif not found:
        errors.append(f"{name}: no AVX instruction, so this test is blind")
    return errors


def main(arguments):
    objects = [a for argument in arguments for a in argument.split(";")]
    names = {pathlib.Path(o).name.split(".")[0] for o in objects}
    errors = [f"no object of {name}.cpp was given" for name in KERNELS if name not in names]
    for path in objects:
        errors += errors_of(path)
    for error in errors:
        print(error)
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
