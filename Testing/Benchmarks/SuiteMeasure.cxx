// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SuiteMeasure.cxx
 * @brief Runs a program and says what it took, for Suite.py.
 *
 *     SuiteMeasure SECONDS REPORT PROGRAM [ARGUMENT]...
 *
 * The program may take SECONDS of processor time. REPORT gets one line of "name value" pairs: exit
 * (its status, or -1), signal (that ended it, or 0), user, system and wall (seconds), megabytes
 * (its peak memory). A process of its own, small on purpose: a process counts the memory of the one
 * that it was copied from. The limit is watched from here: under a limit of its own (RLIMIT_CPU) Linux
 * tells a process its time in steps of 4 milliseconds, which is as much as small models take.
 * Exit status: 0 if the program was run, 2 if not.
 */
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace
{
double GetSeconds(const timeval& time)
{
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/** The processor time, in seconds, that all threads of a process have taken. */
double GetProcessorTime(pid_t process)
{
  clockid_t clock;
  timespec time;
  return clock_getcpuclockid(process, &clock) == 0 && clock_gettime(clock, &time) == 0
    ? static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec)
    : 0.0;
}

/**
 * Waits for a child, and ends it where it takes longer than the limit, in seconds of processor time.
 * @param childEnds the signal that says so, blocked
 */
bool WaitFor(pid_t child, double limit, const sigset_t& childEnds, int& status, rusage& usage)
{
  // Some programs do not end at the first signal.
  constexpr double patience = 5.0;
  const timespec interval{ 0, 50 * 1000 * 1000 };
  pid_t ended = 0;
  while ((ended = wait4(child, &status, WNOHANG, &usage)) == 0)
  {
    const double taken = GetProcessorTime(child);
    if (taken >= limit)
    {
      kill(child, taken >= limit + patience ? SIGKILL : SIGXCPU);
    }
    sigtimedwait(&childEnds, nullptr, &interval);
  }
  return ended == child;
}
} // namespace

int main(int argc, char* argv[])
{
  if (argc < 4)
  {
    std::fprintf(stderr, "usage: SuiteMeasure SECONDS REPORT PROGRAM [ARGUMENT]...\n");
    return 2;
  }
  const double limit = std::atof(argv[1]);
  sigset_t childEnds;
  sigemptyset(&childEnds);
  sigaddset(&childEnds, SIGCHLD);
  sigprocmask(SIG_BLOCK, &childEnds, nullptr);
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0)
  {
    sigprocmask(SIG_UNBLOCK, &childEnds, nullptr);
    const rlimit noCores{ 0, 0 };
    setrlimit(RLIMIT_CORE, &noCores);
    execvp(argv[3], argv + 3);
    std::perror(argv[3]);
    _exit(127);
  }
  int status = 0;
  rusage usage;
  if (child < 0 || !WaitFor(child, limit, childEnds, status, usage))
  {
    std::perror("SuiteMeasure");
    return 2;
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  std::FILE* report = std::fopen(argv[2], "w");
  if (!report)
  {
    std::perror(argv[2]);
    return 2;
  }
  std::fprintf(report, "exit %d signal %d user %g system %g wall %g megabytes %g\n",
    WIFEXITED(status) ? WEXITSTATUS(status) : -1, WIFSIGNALED(status) ? WTERMSIG(status) : 0,
    GetSeconds(usage.ru_utime), GetSeconds(usage.ru_stime), wall.count(),
    static_cast<double>(usage.ru_maxrss) / 1024.0);
  return std::fclose(report) == 0 ? 0 : 2;
}
