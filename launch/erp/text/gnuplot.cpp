#include "launch/erp/text/gnuplot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "interfaces/recording/error.hpp"

extern char** environ;

namespace launch {
namespace {

using TemporaryFile = std::unique_ptr<std::FILE, decltype(&std::fclose)>;

TemporaryFile make_temporary_file() {
  TemporaryFile file(std::tmpfile(), &std::fclose);
  if (!file)
    throw recording::WriteError(std::string("cannot make a temporary file: ") +
                                std::strerror(errno) + "; check TMPDIR");
  return file;
}

std::string terminal(const std::string& file, int panels) {
  const std::string size =
      " size " + std::to_string(picture_width) + "," + std::to_string(picture_height(panels));
  constexpr auto* font = " font 'DejaVu Sans,11' background rgb 'white'";
  if (file.ends_with(".png")) return "set terminal pngcairo noenhanced" + size + font + "\n";
  if (file.ends_with(".svg")) return "set terminal svg noenhanced" + size + font + "\n";
  throw recording::RecordingError(file +
                                  ": can draw .svg and .png only; choose one of these extensions");
}

/// Runs gnuplot with the file descriptors `in`, `out` and `err` as stdin, stdout and stderr.
/// Returns its wait status.
int run_gnuplot(int in, int out, int err) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, in, 0);
  posix_spawn_file_actions_adddup2(&files, out, 1);
  posix_spawn_file_actions_adddup2(&files, err, 2);
  std::string name = "gnuplot";
  char* argv[] = {name.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, "gnuplot", &files, nullptr, argv, environ);
  posix_spawn_file_actions_destroy(&files);
  if (error)
    throw recording::RecordingError(std::string("cannot run gnuplot: ") + std::strerror(error) +
                                    "; install it with: apt-get install gnuplot-nox");
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

std::string first_lines(std::FILE* file) {
  char text[400];  // enough for an error message
  std::rewind(file);
  std::string message(text, std::fread(text, 1, sizeof text, file));
  while (message.ends_with('\n')) message.pop_back();
  return message;
}

}  // namespace

void draw(const PlotScript& script, const std::string& file) {
  const std::string commands = terminal(file, script.panels) + script.commands;
  const TemporaryFile in = make_temporary_file(), err = make_temporary_file();
  if (std::fwrite(commands.data(), 1, commands.size(), in.get()) != commands.size() ||
      std::fflush(in.get()) != 0)
    throw recording::WriteError("cannot write gnuplot's commands; free some space in TMPDIR");
  std::rewind(in.get());
  const std::string partial_file = file + ".part";
  const int out = ::open(partial_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (out < 0)
    throw std::invalid_argument(file + ": cannot create: " + std::strerror(errno) +
                                "; name another file with --out");
  try {
    const int status = run_gnuplot(fileno(in.get()), out, fileno(err.get()));
    const off_t size = ::lseek(out, 0, SEEK_END);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || size <= 0)
      throw recording::WriteError(file + ": gnuplot failed: " + first_lines(err.get()) +
                                  "; check the disk, or export the recording and draw it yourself");
    if (::rename(partial_file.c_str(), file.c_str()) != 0)
      throw recording::WriteError(file + ": cannot rename: " + std::strerror(errno) +
                                  "; check the folder");
  } catch (...) {
    ::close(out);
    ::unlink(partial_file.c_str());
    throw;
  }
  ::close(out);
}

}  // namespace launch
