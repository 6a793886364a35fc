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
 * that it was copied from.
 * Exit status: 0 if the program was run, 2 if not.
 */
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace
{
double GetSeconds(const timeval& time)
{
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}
} // namespace

int main(int argc, char* argv[])
{
  if (argc < 4)
  {
    std::fprintf(stderr, "usage: SuiteMeasure SECONDS REPORT PROGRAM [ARGUMENT]...\n");
    return 2;
  }
  const auto limit = static_cast<rlim_t>(std::atof(argv[1]));
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0)
  {
    // The second one is for programs that do not end at the first.
    const rlimit processorTime{ limit, limit + 5 };
    const rlimit noCores{ 0, 0 };
    setrlimit(RLIMIT_CPU, &processorTime);
    setrlimit(RLIMIT_CORE, &noCores);
    execvp(argv[3], argv + 3);
    std::perror(argv[3]);
    _exit(127);
  }
  int status = 0;
  rusage usage;
  if (child < 0 || wait4(child, &status, 0, &usage) != child)
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
