// Work of one rank for all: reading, checking or writing a file. All ranks continue with the same result, or
// throw the same error.
#pragma once

#include <array>
#include <cstring>
#include <exception>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "core/scene/errors.hpp"
#include "parallel/mpi.hpp"

namespace mpm::parallel {

/// Rank 0's bytes, of any length, on every rank. Collective.
std::string broadcast(const Communicator& comm, std::string bytes);

namespace detail {

std::string to_bytes(const core::InputErrors& errors);
core::InputErrors errors_from(const std::string& bytes);

template <class T>
std::string bytes_of(const T& value) {
  if constexpr (std::is_same_v<T, std::string>) {
    return value;
  } else {
    static_assert(std::is_trivially_copyable_v<T>,
                  "only plain data and std::string can be sent between ranks");
    return std::string(reinterpret_cast<const char*>(&value), sizeof(T));
  }
}

template <class T>
T value_from(std::string bytes) {
  if constexpr (std::is_same_v<T, std::string>) {
    return bytes;
  } else {
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }
}

// First letter of the broadcast text.
inline constexpr char is_value = 'v', is_input_errors = 'i', is_other = 'x', is_first_kept = 'A';

template <class... Kept>
char letter_of(const std::exception& e) {
  char letter = is_other;
  [[maybe_unused]] char next = is_first_kept;
  ((letter = letter == is_other && dynamic_cast<const Kept*>(&e) != nullptr ? next : letter, ++next), ...);
  return letter;
}

template <class... Kept>
[[noreturn]] void rethrow(char letter, const std::string& text) {
  if (letter == is_input_errors) throw errors_from(text);
  [[maybe_unused]] char next = is_first_kept;
  ((letter == next++ ? throw Kept(text) : void()), ...);
  throw std::runtime_error(text);
}

}  // namespace detail

/// Runs f() on rank 0 and returns its result, a std::string, plain data or nothing, on every rank. If it
/// throws, every rank throws: InputErrors unchanged; the types `Kept`, each made from its text; anything else
/// as a std::runtime_error with the same text. std::bad_alloc is thrown on rank 0 alone, while the others
/// wait: the caller must call abort(). Collective.
template <class... Kept, class F>
auto on_root_then_all(const Communicator& comm, F f) -> std::invoke_result_t<F&> {
  using Result = std::invoke_result_t<F&>;
  std::string message;
  if (comm.rank() == 0) {
    try {
      if constexpr (std::is_void_v<Result>) {
        f();
        message = detail::is_value;
      } else {
        message = detail::is_value + detail::bytes_of<Result>(f());
      }
    } catch (const core::InputErrors& e) {
      message = detail::is_input_errors + detail::to_bytes(e);
    } catch (const std::bad_alloc&) {
      throw;  // a message may not fit into memory either: the program ends every rank
    } catch (const std::exception& e) { message = detail::letter_of<Kept...>(e) + std::string(e.what()); }
  }
  message = broadcast(comm, std::move(message));
  if (message[0] != detail::is_value) detail::rethrow<Kept...>(message[0], message.substr(1));
  if constexpr (!std::is_void_v<Result>) return detail::value_from<Result>(message.erase(0, 1));
}

}  // namespace mpm::parallel
