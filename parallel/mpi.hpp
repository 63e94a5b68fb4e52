// Thin owners over MPI: the library's lifetime, a communicator, persistent messages. Every return code is
// checked. Sizes are 64-bit here, MPI counts with an int: long messages are split into pieces. The length of
// a piece is an argument, so that tests can split short messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <mpi.h>

namespace mpm::parallel {

/// A failed MPI call, perhaps on this rank alone: the others may be waiting, so the caller must call abort().
class MpiError : public std::runtime_error {
 public:
  MpiError(const char* function, int code);
};

/// Bytes of the longest message in one piece; a multiple of the size of what is sent.
inline constexpr std::size_t longest_piece = std::size_t{1} << 30;

/// Throws MpiError unless `code` is MPI_SUCCESS; std::bad_alloc if this process has no memory left, which MPI
/// calls an internal error.
void check(int code, const char* function);
/// `n` as an MPI count; throws std::length_error if it is too large.
int count_of(std::size_t n);

/// Ends every rank of the run at once. For bugs, and for errors that the ranks have not agreed on.
[[noreturn]] void abort(int exit_code);

/// Whether the program that started the ranks on this machine, mpirun or its daemon, has ended since. Never
/// without one.
bool launcher_ended();

/// Owns MPI for the duration of main: constructed first, destroyed last. An exception that leaves its scope
/// ends every rank, because the other ranks may be waiting for this one.
class Environment {
 public:
  /// Starts MPI for calls from the main thread only.
  Environment(int& argc, char**& argv);
  ~Environment();
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
};

/// The contributions of all ranks, concatenated in rank order; that of rank r is [begin[r], begin[r + 1]).
template <class T>
struct Gathered {
  std::vector<T> items;
  std::vector<std::size_t> begin;
  std::span<const T> of(int rank) const {
    const auto r = static_cast<std::size_t>(rank);
    return std::span(items).subspan(begin[r], begin[r + 1] - begin[r]);
  }
};

class Communicator {
 public:
  /// A new communicator over all ranks. Collective.
  static Communicator world();
  /// The same ranks, with messages separate from this one's. Collective.
  Communicator duplicate() const { return Communicator(handle_); }

  Communicator(Communicator&& other) noexcept;
  Communicator& operator=(Communicator&&) = delete;
  ~Communicator();

  int rank() const { return rank_; }
  int size() const { return size_; }
  MPI_Comm handle() const { return handle_; }

  /// Entry by entry over the ranks, in place. Collective.
  void reduce(std::span<double> values, MPI_Op op, std::size_t longest = longest_piece) const;
  /// Collective.
  void reduce(std::span<std::int64_t> values, MPI_Op op, std::size_t longest = longest_piece) const;
  /// Copies `root`'s bytes to every rank, in place. Collective.
  void broadcast(std::span<std::byte> bytes, int root = 0, std::size_t longest = longest_piece) const;

  /// Appends what `rank` sends next with Requests::send_unannounced and the same `longest`. Blocks until it
  /// arrives.
  void receive_onto(std::vector<double>& data, int rank, int tag, std::size_t longest = longest_piece) const;

  /// Every rank's list to all ranks. Collective.
  template <class T>
  Gathered<T> all_gather(std::span<const T> mine, std::size_t longest = longest_piece) const {
    static_assert(std::is_trivially_copyable_v<T>);
    Gathered<T> all;
    all.begin = gather_begins(mine.size());
    all.items.resize(all.begin.back());
    gather_bytes(mine.data(), all.items.data(), sizeof(T), all.begin, longest);
    return all;
  }

  /// Sends the part [begin[r], begin[r + 1]) of `send` to rank r; received data are stored in rank order.
  /// Messages are split at `longest` bytes. Collective.
  template <class T>
  std::vector<T> all_to_all(std::span<const T> send, std::span<const std::size_t> begin,
                            std::size_t longest = longest_piece) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::vector<std::size_t> arriving = exchange_begins(begin);
    std::vector<T> received(arriving.back());
    exchange_bytes(send.data(), begin, received.data(), arriving, sizeof(T), longest);
    return received;
  }

 private:
  explicit Communicator(MPI_Comm parent);
  std::vector<std::size_t> gather_begins(std::size_t mine) const;
  void gather_bytes(const void* mine, void* all, std::size_t item, std::span<const std::size_t> begin,
                    std::size_t longest) const;
  std::vector<std::size_t> exchange_begins(std::span<const std::size_t> begin) const;
  void exchange_bytes(const void* send, std::span<const std::size_t> send_begin, void* receive,
                      std::span<const std::size_t> receive_begin, std::size_t item,
                      std::size_t longest) const;

  MPI_Comm handle_ = MPI_COMM_NULL;
  int rank_ = 0;
  int size_ = 1;
  int exceptions_ = 0;  ///< active at construction; if more are at destruction, the handle is not freed
};

/// Pending messages. Their buffers must not change until wait_all() returns.
class Requests {
 public:
  void send(const Communicator& comm, const void* data, std::size_t bytes, int rank, int tag);
  void receive(const Communicator& comm, void* data, std::size_t bytes, int rank, int tag);
  /// To a rank to which the length was not sent: pieces of `longest` bytes and a shorter last one.
  void send_unannounced(const Communicator& comm, const void* data, std::size_t bytes, int rank, int tag,
                        std::size_t longest = longest_piece);
  void wait_all();

 private:
  std::vector<MPI_Request> requests_;
};

/// Messages of fixed buffer and length, set up once and sent repeatedly.
class PersistentRequests {
 public:
  PersistentRequests() = default;
  ~PersistentRequests();
  PersistentRequests(PersistentRequests&& other) noexcept : requests_(std::move(other.requests_)) {
    other.requests_.clear();
  }
  PersistentRequests& operator=(PersistentRequests&& other) noexcept {
    requests_.swap(other.requests_);
    return *this;
  }

  /// Each adds one request, numbered from 0.
  void add_send(const Communicator& comm, const double* data, std::size_t n, int rank, int tag);
  void add_receive(const Communicator& comm, double* data, std::size_t n, int rank, int tag);

  std::size_t size() const { return requests_.size(); }
  void start(std::size_t i);
  void start_all();
  /// Number of a completed request, or -1 if none is active.
  int wait_any();
  void wait_all();

 private:
  std::vector<MPI_Request> requests_;
};

}  // namespace mpm::parallel
