#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The same bits elsewhere: builds the engine for other machines, and with other compilers and options, runs every line of
corpus/hashes.txt there, and prints a table.

usage: elsewhere/run.py [--packages] [--reference | --one-file] [--scenes PROGRAM] [--frames N] NAME...

A NAME is an architecture, a level (compiler and options for this machine), or one of the groups `architectures`, `levels` and `sanitizers`.
--packages prints the Debian packages that they need, and does nothing else. --reference builds and runs the reference path alone,
--one-file the reference engine in one file (reference/) alone.
--scenes names surefill_hashed_scenes of this machine, if it is built already. --frames draws N random frames on both paths instead.
Builds go to build/elsewhere/NAME. Exit 0: all lines are equal everywhere; 1: not; 2: wrong usage.
"""
import concurrent.futures
import dataclasses
import os
import pathlib
import re
import resource
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "elsewhere"
PARTS = os.cpu_count() or 1


@dataclasses.dataclass
class Machine:
    compiler: str
    packages: list = dataclasses.field(default_factory=list)
    run: list = dataclasses.field(default_factory=list)  # before the program; nothing where this machine runs it
    cmake: list = dataclasses.field(default_factory=list)
    flags: str = ""
    link: str = ""
    ending: str = ""  # of programs
    paths: tuple = ("fast", "reference", "one file")  # the last is reference/surefill_reference.cpp, with none of the project's flags
    emulator: str = ""  # what says its version, where there is one


def cross(name, processor, qemu, **more):
    return Machine(f"{name}-g++", [f"g++-{name}", "qemu-user"], [f"qemu-{qemu}"],
                   ["-DCMAKE_SYSTEM_NAME=Linux", f"-DCMAKE_SYSTEM_PROCESSOR={processor}", f"-DCMAKE_C_COMPILER={name}-gcc"],
                   link="-static", emulator=f"qemu-{qemu}", **more)


ARCHITECTURES = {
    "aarch64": cross("aarch64-linux-gnu", "aarch64", "aarch64"),
    "s390x": cross("s390x-linux-gnu", "s390x", "s390x"),
    "wasm32": Machine("clang++-19",
                      ["clang-19", "lld-19", "wasi-libc", "libc++-19-dev-wasm32", "libc++abi-19-dev-wasm32", "libclang-rt-19-dev-wasm32",
                       "nodejs"],
                      ["node", "--no-warnings", "--experimental-wasi-unstable-preview1", str(ROOT / "elsewhere" / "wasi.mjs")],
                      ["-DCMAKE_SYSTEM_NAME=Generic", "-DCMAKE_SYSTEM_PROCESSOR=wasm32", "-DCMAKE_C_COMPILER=clang-19",
                       "-DCMAKE_CXX_COMPILER_TARGET=wasm32-wasi", "-DCMAKE_C_COMPILER_TARGET=wasm32-wasi",
                       "-DSUREFILL_REFERENCE_ONLY=ON"],
                      # The reader throws where a scene is wrong, which none of these is.
                      flags="-fignore-exceptions", link="-Wl,-z,stack-size=8388608", paths=("reference", "one file"), emulator="node"),
    "ppc64le": cross("powerpc64le-linux-gnu", "ppc64le", "ppc64le"),
    "riscv64": cross("riscv64-linux-gnu", "riscv64", "riscv64"),
    "armhf": cross("arm-linux-gnueabihf", "armv7l", "arm"),
    "i686": Machine("i686-linux-gnu-g++", ["g++-i686-linux-gnu"], [],
                    ["-DCMAKE_SYSTEM_NAME=Linux", "-DCMAKE_SYSTEM_PROCESSOR=i686", "-DCMAKE_C_COMPILER=i686-linux-gnu-gcc"],
                    flags="-msse4.2 -maes -mpclmul -mfpmath=sse", link="-static"),
    "i686-sse2": Machine("i686-linux-gnu-g++", ["g++-i686-linux-gnu"], [],
                         ["-DCMAKE_SYSTEM_NAME=Linux", "-DCMAKE_SYSTEM_PROCESSOR=i686", "-DCMAKE_C_COMPILER=i686-linux-gnu-gcc"],
                         flags="-msse2 -mfpmath=sse", link="-static"),
    "windows": Machine("x86_64-w64-mingw32-g++-posix", ["g++-mingw-w64-x86-64-posix", "wine64"], ["/usr/lib/wine/wine64"],
                       ["-DCMAKE_SYSTEM_NAME=Windows", "-DCMAKE_SYSTEM_PROCESSOR=x86_64",
                        "-DCMAKE_C_COMPILER=x86_64-w64-mingw32-gcc-posix"],
                       flags="-msse4.2 -maes -mpclmul", link="-static", ending=".exe", emulator="/usr/lib/wine/wine64"),
}


def level(compiler, flags, **more):
    c_compiler = compiler.replace("clang++", "clang").replace("g++", "gcc")
    return Machine(compiler, flags=flags, cmake=["-DCMAKE_BUILD_TYPE=None", f"-DCMAKE_C_COMPILER={c_compiler}"], **more)


CLANG = ["clang-19", "lld-19", "llvm-19"]  # CMake takes the archiver of clang's version
LEVELS = {f"g++{flag}": level("g++", flag) for flag in ("-O0", "-O1", "-O2", "-O3", "-Os")}
LEVELS |= {"g++-march=native": level("g++", "-O2 -march=native"), "g++-flto": level("g++", "-O2 -flto=auto")}
LEVELS |= {f"clang++-19{flag}": level("clang++-19", flag, packages=CLANG) for flag in ("-O0", "-O2", "-O3")}
LEVELS |= {
    "clang++-19-march=native": level("clang++-19", "-O2 -march=native", packages=CLANG),
    "clang++-19-flto": level("clang++-19", "-O2 -flto=thin", link="-fuse-ld=lld", packages=CLANG),
    "clang++-19-stdlib=libc++": level("clang++-19", "-O2 -stdlib=libc++", packages=[*CLANG, "libc++-19-dev", "libc++abi-19-dev"]),
}
# The engine alone under sanitizers, which costs minutes where the whole suite under them costs hours.
CHECKED = "-O1 -g -fno-omit-frame-pointer -fno-sanitize-recover=all"
SANITIZERS = {
    "g++-asan-ubsan": level("g++", f"{CHECKED} -fsanitize=address,undefined,float-cast-overflow"),
    "g++-tsan": level("g++", f"{CHECKED} -fsanitize=thread"),
    "clang++-19-asan-ubsan": level("clang++-19", f"{CHECKED} -fsanitize=address,undefined,float-cast-overflow,local-bounds",
                                   packages=[*CLANG, "libclang-rt-19-dev"]),
}
MACHINES = ARCHITECTURES | LEVELS | SANITIZERS


def called(command, log=None, **more):
    """Runs a command; a failure says what the command said."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **more)
    if log is not None:
        log.write_text(done.stdout + done.stderr)
    if done.returncode != 0:
        shown = "\n".join((done.stdout + done.stderr).strip().splitlines()[-30:])
        raise RuntimeError(f"{shown}\nfailed: {' '.join(str(word) for word in command)}")
    return done.stdout


def build(name, machine, targets, reference_only=False):
    folder = BUILD / (f"{name}-reference" if reference_only else name)
    folder.mkdir(parents=True, exist_ok=True)
    headers = BUILD / "highway"
    if not headers.exists():
        headers.mkdir(parents=True)
        (headers / "hwy").symlink_to("/usr/include/hwy")
    options = ["-DSUREFILL_SUITE=OFF", "-DSUREFILL_ELSEWHERE=ON", f"-DCMAKE_CXX_COMPILER={machine.compiler}",
               f"-DCMAKE_CXX_FLAGS={machine.flags}", f"-DCMAKE_EXE_LINKER_FLAGS={machine.link}"]
    if name in ARCHITECTURES:
        options += [f"-Dhwy_DIR={ROOT}/elsewhere/highway", f"-DSUREFILL_HIGHWAY_HEADERS={headers}", "-DCMAKE_BUILD_TYPE=Release",
                    "-DCMAKE_TRY_COMPILE_TARGET_TYPE=STATIC_LIBRARY"]
    if reference_only:
        options.append("-DSUREFILL_REFERENCE_ONLY=ON")
    called(["cmake", "-G", "Ninja", "-S", ROOT, "-B", folder, *options, *machine.cmake], folder / "configure.log")
    called(["cmake", "--build", folder, "--target", *targets], folder / "build.log")
    return folder / "elsewhere"


def random_scenes(program):
    """The folder of random scenes, written by a program of this machine."""
    scenes = BUILD / "scenes"
    if program is None:
        here = Machine("g++", cmake=["-DCMAKE_BUILD_TYPE=Release"])
        program = build("here", here, ["surefill_hashed_scenes"], True) / "surefill_hashed_scenes"
    called([program, scenes])
    return scenes


def in_parts(command, of_part):
    """The outputs of as many processes as there are processors; of_part(n) are the arguments of one."""
    environment = os.environ | {"WINEDEBUG": "-all", "WINEPREFIX": str(BUILD / "wine")}

    def part(n):
        done = subprocess.run([str(word) for word in [*command, *of_part(n)]], capture_output=True, text=True, check=False, env=environment)
        if done.returncode not in (0, 1) or not done.stdout:
            raise RuntimeError(f"no answer (exit status {done.returncode}): {command[-1]}\n{done.stdout}{done.stderr}")
        if done.returncode != 0:
            print("\n".join(done.stdout.strip().splitlines()[:5]), file=sys.stderr)
        return done.stdout.strip().splitlines()[-1]

    with concurrent.futures.ThreadPoolExecutor(PARTS) as pool:
        return list(pool.map(part, range(PARTS)))


def lines_equal(machine, programs, scenes, path):
    """What drew, how many lines are equal, and of how many."""
    program = programs.parent / "reference" / "surefill_reference_hashes" if path == "one file" else programs / "surefill_hashes"
    command = [*machine.run, program.with_name(program.name + machine.ending), *(["--reference"] if path == "reference" else [])]
    corpus = ROOT / "corpus"
    answers = in_parts(command, lambda n: ["--part", f"{n}/{PARTS}", corpus / "hashes.txt", corpus / "cases", scenes])
    counts = [re.fullmatch(r"(.*): (\d+) of (\d+) lines equal", answer) for answer in answers]
    return counts[0][1], sum(int(c[2]) for c in counts), sum(int(c[3]) for c in counts)


def frames(name, number):
    """Random frames on both paths, with a seed for each process: whether there is no difference."""
    machine = MACHINES[name]
    programs = build(name, machine, ["surefill_frames"])
    clock = Clock()
    command = [*machine.run, programs / f"surefill_frames{machine.ending}"]
    right = True
    for answer in in_parts(command, lambda n: [(number + PARTS - 1) // PARTS, 1 + 1000000 * n]):
        right = right and answer.endswith(": 0 differences")
        print(f"{name:<26} fast path against reference path: {answer}", flush=True)
    print(f"{name:<26} run in {clock}", flush=True)
    return right


def version(command, option="--version"):
    """The first word that the program says of its version and that is one."""
    said = re.search(r"\d+(\.\d+)*", called([command, option]).replace(pathlib.Path(command).name, ""))
    return said.group() if said else "?"


class Clock:
    """Seconds since it was made, and those that a processor worked for them."""

    def __init__(self):
        self.begun, self.used = time.monotonic(), self.processor()

    @staticmethod
    def processor():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    def __str__(self):
        return f"{time.monotonic() - self.begun:.0f} s ({self.processor() - self.used:.0f} s of a processor)"


def rows(name, scenes, only):
    """The lines of the table for one machine, and whether all is equal. Of the paths only one, unless that is None."""
    machine = MACHINES[name]
    clock = Clock()
    paths = [path for path in machine.paths if path == only or only is None]
    targets = ["surefill_hashes", "surefill_sizes"] if paths != ["one file"] else ["surefill_sizes"]
    programs = build(name, machine, targets + ["surefill_reference_hashes"] * ("one file" in paths), only is not None)
    built = str(clock)
    called([*machine.run, programs / f"surefill_sizes{machine.ending}"], env=os.environ | {"WINEDEBUG": "-all", "WINEPREFIX": str(BUILD / "wine")})
    compiler = f"clang {version(machine.compiler)}" if "clang" in machine.compiler else f"g++ {version(machine.compiler, '-dumpfullversion')}"
    emulated = f"{pathlib.Path(machine.emulator).name} {version(machine.emulator)}" if machine.emulator else "not emulated"
    if machine.emulator.startswith("qemu"):
        emulated = f"emulated, {emulated}"
    right = True
    for path in paths:
        clock = Clock()
        who, equal, lines = lines_equal(machine, programs, scenes, path)
        right = right and equal == lines
        print(f"{name:<26} {compiler:<14} {path if path == 'one file' else who:<10} {equal} of {lines} equal   {emulated:<28} built in {built}, run in {clock}", flush=True)
    return right


def main():
    arguments = sys.argv[1:]
    given = {}
    for option in ("--scenes", "--frames"):
        if option in arguments[:-1]:
            at = arguments.index(option)
            given[option] = arguments[at + 1]
            del arguments[at : at + 2]
    flags = {a for a in arguments if a.startswith("--")}
    names = []
    for argument in arguments:
        if not argument.startswith("--"):
            names += {"architectures": list(ARCHITECTURES), "levels": list(LEVELS), "sanitizers": list(SANITIZERS)}.get(argument, [argument])
    unknown = [n for n in names if n not in MACHINES] + sorted(flags - {"--packages", "--reference", "--one-file"})
    if unknown or not names or not given.get("--frames", "1").isdigit():
        print(__doc__ + f"\nknown: {' '.join(MACHINES)}\n" + (f"unknown: {' '.join(unknown)}" if unknown else ""), file=sys.stderr)
        return 2
    if "--packages" in flags:
        print(" ".join(dict.fromkeys(package for name in names for package in MACHINES[name].packages)))
        return 0
    failed = []
    only = "reference" if "--reference" in flags else "one file" if "--one-file" in flags else None
    try:
        scenes = None if "--frames" in given else random_scenes(given.get("--scenes"))
    except RuntimeError as error:
        print(error, file=sys.stderr)
        return 1
    for name in names:
        try:
            right = frames(name, int(given["--frames"])) if "--frames" in given else rows(name, scenes, only)
        except (RuntimeError, OSError) as error:
            right = False
            print(f"{name}: {error}", file=sys.stderr, flush=True)
        if not right:
            failed.append(name)
    if failed:
        print(f"not the same bits: {' '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
