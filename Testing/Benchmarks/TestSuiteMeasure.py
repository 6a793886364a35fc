# SPDX-License-Identifier: BSD-3-Clause
"""SuiteMeasure ends what takes too long, and leaves the clock of programs exact.

    TestSuiteMeasure.py SUITEMEASURE
"""
import os
import signal
import subprocess
import sys
import tempfile

# Prints the median step of the clock by which programs measure their processor time.
CLOCK_STEP = """
import statistics, time
steps = []
last = time.process_time()
while len(steps) < 9:
    now = time.process_time()
    if now != last:
        steps.append(now - last)
    last = now
print(statistics.median(steps))
"""
ENDLESS = "while True: pass"
# The exit status where a program cannot be started, as shells have it.
NOT_FOUND = 127


def Measure(limit, *command):
    """What it reports of a program, and what the program prints."""
    with tempfile.TemporaryDirectory() as folder:
        report = os.path.join(folder, "report")
        run = subprocess.run([sys.argv[1], "%g" % limit, report, *command], check=True,
                             stdout=subprocess.PIPE, universal_newlines=True)
        with open(report, encoding="ascii") as file:
            words = file.read().split()
    return dict(zip(words[0::2], map(float, words[1::2]))), run.stdout


def Main():
    failures = []

    def Expect(isTrue, what):
        if not isTrue:
            failures.append(what)

    step = float(subprocess.check_output([sys.executable, "-c", CLOCK_STEP]))
    result, output = Measure(30.0, sys.executable, "-c", CLOCK_STEP)
    print("the clock steps by %g s, and by %g s when measured" % (step, float(output)))
    Expect(result["exit"] == 0 and result["signal"] == 0, "a good program: %s" % result)
    Expect(float(output) < max(5e-4, 2.0 * step), "the clock is coarse")

    result, _ = Measure(0.5, sys.executable, "-c", ENDLESS)
    taken = result["user"] + result["system"]
    print("ended after %g s of 0.5" % taken)
    Expect(result["signal"] == signal.SIGXCPU, "one that is too long: %s" % result)
    Expect(0.4 < taken < 2.0, "ended after %g s" % taken)

    ignore = "import signal; signal.signal(signal.SIGXCPU, signal.SIG_IGN)\n"
    result, _ = Measure(0.5, sys.executable, "-c", ignore + ENDLESS)
    Expect(result["signal"] == signal.SIGKILL, "one that ignores the signal: %s" % result)

    result, _ = Measure(30.0, os.path.join(os.sep, "no", "such", "program"))
    Expect(result["exit"] == NOT_FOUND, "one that is not there: %s" % result)
    print("\n".join(failures) or "all as it should be")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(Main())
