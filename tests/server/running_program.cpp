#include "tests/server/running_program.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <numeric>
#include <stdexcept>

namespace flogmap {
namespace {

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> all;
  for (std::string& word : words) all.push_back(word.data());
  all.push_back(nullptr);
  return all;
}

/// Starts it with stdout closed off and stderr into the pipe.
pid_t spawn(std::vector<std::string> arguments, std::vector<std::string> environment, int pipe) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, pipe, STDERR_FILENO);
  pid_t pid = -1;
  const int error = ::posix_spawn(&pid, FLOGMAP_PROGRAM, &files, nullptr, pointers(arguments).data(),
                                  pointers(environment).data());
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) throw std::runtime_error(std::string(FLOGMAP_PROGRAM) + " cannot be started");
  return pid;
}

}  // namespace

RunningProgram::RunningProgram(const std::vector<std::string>& arguments,
                               const std::vector<std::string>& environment) {
  std::vector<std::string> all{FLOGMAP_PROGRAM, "serve", "--listen",   "127.0.0.1:0",
                               "--log-format",  "json",  "--web-root", "/nonexistent"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  std::array<int, 2> pipe{};
  if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  pid_ = spawn(all, environment, pipe[1]);
  ::close(pipe[1]);
  listener_ = std::thread([this, read_end = pipe[0]] { listen(read_end); });
  const bool up = wait_for_log("\"serving\"", std::chrono::seconds(60));
  const std::vector<std::string> lines = log();
  const auto said = std::find_if(lines.begin(), lines.end(), [](const std::string& line) {
    return line.find("\"serving\"") != std::string::npos;
  });
  if (!up || said == lines.end()) {
    end(SIGKILL);
    throw std::runtime_error("flogmap did not come up: " +
                             std::accumulate(lines.begin(), lines.end(), std::string()));
  }
  const std::string url = nlohmann::json::parse(*said)["url"];
  port_ = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
}

RunningProgram::~RunningProgram() { end(SIGKILL); }

void RunningProgram::listen(int pipe) {
  std::string rest;
  std::array<char, 4096> part{};
  for (ssize_t size = 0; (size = ::read(pipe, part.data(), part.size())) > 0;) {
    rest.append(part.data(), static_cast<std::size_t>(size));
    const std::scoped_lock lock(mutex_);
    for (std::size_t end = 0; (end = rest.find('\n')) != std::string::npos; rest.erase(0, end + 1)) {
      log_.push_back(rest.substr(0, end));
    }
    more_.notify_all();
    if (hung_up_) break;
  }
  ::close(pipe);
  const std::scoped_lock lock(mutex_);
  closed_ = true;
  more_.notify_all();
}

int RunningProgram::end(int signal) {
  if (pid_ < 0) return 0;
  ::kill(pid_, signal);
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = -1;
  listener_.join();
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

std::vector<std::string> RunningProgram::log() const {
  const std::scoped_lock lock(mutex_);
  return log_;
}

bool RunningProgram::wait_for_log(const std::string& part, std::chrono::seconds patience) {
  std::unique_lock lock(mutex_);
  const auto said = [&] {
    return std::any_of(log_.begin(), log_.end(),
                       [&](const std::string& line) { return line.find(part) != std::string::npos; });
  };
  more_.wait_for(lock, patience, [&] { return closed_ || said(); });
  return said();
}

}  // namespace flogmap
