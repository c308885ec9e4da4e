#include "subprocess.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>

#include "soft_tissue_sim/base/error.h"
#include "soft_tissue_sim/base/timer.h"

namespace soft_tissue
{
namespace
{
struct Pipe
{
  int ends[2] = {-1, -1};
  Pipe()
  {
    if (pipe2(ends, O_CLOEXEC) != 0)
    {
      throw Error("can't make a pipe to run a program");
    }
  }
  ~Pipe()
  {
    closeEnd(0);
    closeEnd(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void closeEnd(int i)
  {
    if (ends[i] >= 0)
    {
      close(ends[i]);
      ends[i] = -1;
    }
  }
};

/** In the child: becomes the program, or writes a byte to `failure` and ends. */
[[noreturn]] void becomeProgram(char* const* arguments, const char* folder, int output, int failure)
{
  setpgid(0, 0);
  const int nothing = open("/dev/null", O_RDONLY);
  if (chdir(folder) == 0 && dup2(nothing, 0) == 0 && dup2(output, 1) == 1 && dup2(output, 2) == 2)
  {
    execvp(arguments[0], arguments);
  }
  const char failed = 1;
  const auto written = write(failure, &failed, 1);
  _exit(written == 1 ? 127 : 126);
}

/** Collects the output until it ends or the time is over. @return false if it is over */
bool collect(int output, double timeout_s, std::string& text)
{
  constexpr std::size_t kLongest = 8000;
  const Timer timer;
  while (true)
  {
    const double left_s = timeout_s - timer.seconds();
    pollfd waiting = {output, POLLIN, 0};
    const int ready =
        left_s > 0.0 ? poll(&waiting, 1, static_cast<int>(std::min(left_s, 3600.0) * 1e3) + 1) : 0;
    if (ready < 0 && errno == EINTR)
    {
      continue;
    }
    if (left_s <= 0.0)
    {
      return false;
    }
    char buffer[4096];
    const ssize_t count = ready > 0 ? read(output, buffer, sizeof(buffer)) : 0;
    if (ready > 0 && count <= 0)
    {
      return true;
    }
    text.append(buffer, static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    text.erase(0, text.size() > kLongest ? text.size() - kLongest : 0);
  }
}
}  // namespace

ProgramResult runProgram(const std::vector<std::string>& words, const std::string& folder,
                         double timeout_s)
{
  std::vector<char*> arguments;
  for (const std::string& word : words)
  {
    arguments.push_back(const_cast<char*>(word.c_str()));
  }
  arguments.push_back(nullptr);
  Pipe output;
  Pipe failure;
  const pid_t child = fork();
  if (child < 0)
  {
    throw Error("can't start a process for " + words[0]);
  }
  if (child == 0)
  {
    becomeProgram(arguments.data(), folder.c_str(), output.ends[1], failure.ends[1]);
  }
  output.closeEnd(1);
  failure.closeEnd(1);
  ProgramResult result;
  char byte = 0;
  result.started = read(failure.ends[0], &byte, 1) == 0;  // the pipe closes when the program starts
  result.timed_out = !collect(output.ends[0], timeout_s, result.output);
  if (result.timed_out)
  {
    kill(-child, SIGKILL);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR)
  {}
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

TemporaryFolder::TemporaryFolder()
{
  std::string name = (std::filesystem::temp_directory_path() / "soft_tissue_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
  {
    throw Error(name + ": can't make a temporary folder");
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder()
{
  std::error_code ignored;  // a folder that is gone already is as good as removed
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace soft_tissue
