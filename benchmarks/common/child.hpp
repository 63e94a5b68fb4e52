// A measurement in a separate process, for its own peak memory; a crash loses only its row. The parent must
// not have started threads before.
#pragma once

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

namespace mpm::benchmarks {

using Json = nlohmann::ordered_json;

/// f() -> Json, run in a child. Throws std::runtime_error with the child's message on failure.
template <class F>
Json in_child(F f) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    close(ends[0]);
    Json answer;
    try {
      answer = f();
    } catch (const std::exception& e) { answer = {{"error", e.what()}}; }
    const std::string text = answer.dump();
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t n = write(ends[1], text.data() + at, text.size() - at);
      if (n <= 0) _exit(1);
      at += static_cast<std::size_t>(n);
    }
    std::fflush(nullptr);
    _exit(0);
  }
  close(ends[1]);
  std::string text;
  char piece[4096];
  for (ssize_t n; (n = read(ends[0], piece, sizeof piece)) > 0;)
    text.append(piece, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error(WIFSIGNALED(status) ? fmt::format("ended by signal {}", WTERMSIG(status))
                                                 : "ended early");
  }
  Json answer = Json::parse(text);
  if (answer.contains("error")) throw std::runtime_error(answer["error"].template get<std::string>());
  return answer;
}

}  // namespace mpm::benchmarks
