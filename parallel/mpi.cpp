#include "parallel/mpi.hpp"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <limits>
#include <new>
#include <utility>

#include <sys/mman.h>
#include <unistd.h>

namespace mpm::parallel {

namespace {

constexpr int tag_all_to_all = 1;

pid_t launcher = 0;  // NOLINT: the parent when MPI started; 0: none

std::string text_of(const char* function, int code) {
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  if (MPI_Error_string(code, text, &length) != MPI_SUCCESS) length = 0;
  return std::string(function) + ": " + std::string(text, static_cast<std::size_t>(length));
}

/// Whether less is left than MPI may need at once for its buffers.
bool memory_is_exhausted() {
  constexpr std::size_t needed = std::size_t{16} << 20;
  void* const room = ::mmap(nullptr, needed, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED) return true;
  ::munmap(room, needed);
  return false;
}

}  // namespace

MpiError::MpiError(const char* function, int code) : std::runtime_error(text_of(function, code)) {}

void check(int code, const char* function) {
  if (code == MPI_SUCCESS) return;
  if (memory_is_exhausted()) throw std::bad_alloc();
  throw MpiError(function, code);
}

int count_of(std::size_t n) {
  if (n > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw std::length_error("a message of " + std::to_string(n) + " entries is more than MPI can count");
  }
  return static_cast<int>(n);
}

void abort(int exit_code) {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::abort();
}

bool launcher_ended() { return launcher != 0 && ::getppid() != launcher; }

Environment::Environment(int& argc, char**& argv) {
  if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr) launcher = ::getppid();
  int provided = MPI_THREAD_SINGLE;
  check(MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread");
  if (provided < MPI_THREAD_FUNNELED) throw std::runtime_error("this MPI library does not allow threads");
  check(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
}

Environment::~Environment() {
  if (std::uncaught_exceptions() > 0) abort(EXIT_FAILURE);
  MPI_Finalize();
}

Communicator Communicator::world() { return Communicator(MPI_COMM_WORLD); }

Communicator::Communicator(MPI_Comm parent) : exceptions_(std::uncaught_exceptions()) {
  check(MPI_Comm_dup(parent, &handle_), "MPI_Comm_dup");
  check(MPI_Comm_set_errhandler(handle_, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
  check(MPI_Comm_rank(handle_, &rank_), "MPI_Comm_rank");
  check(MPI_Comm_size(handle_, &size_), "MPI_Comm_size");
}

Communicator::Communicator(Communicator&& other) noexcept
    : handle_(std::exchange(other.handle_, MPI_COMM_NULL)),
      rank_(other.rank_),
      size_(other.size_),
      exceptions_(other.exceptions_) {}

Communicator::~Communicator() {
  // Freeing is collective; a rank that unwinds alone would wait here forever.
  if (handle_ != MPI_COMM_NULL && std::uncaught_exceptions() <= exceptions_) MPI_Comm_free(&handle_);
}

namespace {

/// f(part) for the parts of a list, each at most `longest` bytes.
template <class T, class F>
void for_each_part(std::span<T> list, std::size_t longest, F f) {
  const std::size_t most = std::max(longest / sizeof(T), std::size_t{1});
  for (std::size_t first = 0; first < list.size(); first += most)
    f(list.subspan(first, std::min(most, list.size() - first)));
}

}  // namespace

void Communicator::reduce(std::span<double> values, MPI_Op op, std::size_t longest) const {
  for_each_part(values, longest, [&](std::span<double> part) {
    check(MPI_Allreduce(MPI_IN_PLACE, part.data(), count_of(part.size()), MPI_DOUBLE, op, handle_),
          "MPI_Allreduce");
  });
}

void Communicator::reduce(std::span<std::int64_t> values, MPI_Op op, std::size_t longest) const {
  for_each_part(values, longest, [&](std::span<std::int64_t> part) {
    check(MPI_Allreduce(MPI_IN_PLACE, part.data(), count_of(part.size()), MPI_INT64_T, op, handle_),
          "MPI_Allreduce");
  });
}

void Communicator::broadcast(std::span<std::byte> bytes, int root, std::size_t longest) const {
  for_each_part(bytes, longest, [&](std::span<std::byte> part) {
    check(MPI_Bcast(part.data(), count_of(part.size()), MPI_BYTE, root, handle_), "MPI_Bcast");
  });
}

void Communicator::receive_onto(std::vector<double>& data, int rank, int tag, std::size_t longest) const {
  for (std::size_t arrived = longest; arrived == longest;) {
    MPI_Message message = MPI_MESSAGE_NULL;
    MPI_Status status;
    int n = 0;
    check(MPI_Mprobe(rank, tag, handle_, &message, &status), "MPI_Mprobe");
    check(MPI_Get_count(&status, MPI_BYTE, &n), "MPI_Get_count");
    const std::size_t old = data.size();
    arrived = static_cast<std::size_t>(n);
    data.resize(old + arrived / sizeof(double));
    check(MPI_Mrecv(data.data() + old, n, MPI_BYTE, &message, &status), "MPI_Mrecv");
  }
}

std::vector<std::size_t> Communicator::gather_begins(std::size_t mine) const {
  const auto ranks = static_cast<std::size_t>(size_);
  const auto n = static_cast<std::uint64_t>(mine);
  std::vector<std::uint64_t> sizes(ranks);
  check(MPI_Allgather(&n, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, handle_), "MPI_Allgather");
  std::vector<std::size_t> begin(ranks + 1);
  for (std::size_t r = 0; r < ranks; ++r) begin[r + 1] = begin[r] + sizes[r];
  return begin;
}

void Communicator::gather_bytes(const void* mine, void* all, std::size_t item,
                                std::span<const std::size_t> begin, std::size_t longest) const {
  if (begin.back() == 0) return;
  if (begin.back() * item > longest) {  // one rank after the other: MPI counts all ranks' bytes in one int
    const std::span<std::byte> bytes(static_cast<std::byte*>(all), begin.back() * item);
    const auto of = [&](std::size_t r) {
      return bytes.subspan(begin[r] * item, (begin[r + 1] - begin[r]) * item);
    };
    const std::span<std::byte> own = of(static_cast<std::size_t>(rank_));
    std::copy_n(static_cast<const std::byte*>(mine), own.size(), own.begin());
    for (int r = 0; r < size_; ++r) broadcast(of(static_cast<std::size_t>(r)), r, longest);
    return;
  }
  std::vector<int> sizes, places;
  for (std::size_t r = 0; r + 1 < begin.size(); ++r) {
    sizes.push_back(count_of((begin[r + 1] - begin[r]) * item));
    places.push_back(count_of(begin[r] * item));
  }
  check(MPI_Allgatherv(mine, sizes[static_cast<std::size_t>(rank_)], MPI_BYTE, all, sizes.data(),
                       places.data(), MPI_BYTE, handle_),
        "MPI_Allgatherv");
}

std::vector<std::size_t> Communicator::exchange_begins(std::span<const std::size_t> begin) const {
  const auto ranks = static_cast<std::size_t>(size_);
  std::vector<std::uint64_t> out(ranks), in(ranks);
  for (std::size_t r = 0; r < ranks; ++r) out[r] = begin[r + 1] - begin[r];
  check(MPI_Alltoall(out.data(), 1, MPI_UINT64_T, in.data(), 1, MPI_UINT64_T, handle_), "MPI_Alltoall");
  std::vector<std::size_t> arriving(ranks + 1);
  for (std::size_t r = 0; r < ranks; ++r) arriving[r + 1] = arriving[r] + in[r];
  return arriving;
}

void Communicator::exchange_bytes(const void* send, std::span<const std::size_t> send_begin, void* receive,
                                  std::span<const std::size_t> receive_begin, std::size_t item,
                                  std::size_t longest) const {
  const auto* out = static_cast<const std::byte*>(send);
  auto* in = static_cast<std::byte*>(receive);
  const auto parts = [&](std::span<const std::size_t> begin, int rank, auto f) {
    const auto r = static_cast<std::size_t>(rank);
    const std::size_t end = begin[r + 1] * item;
    for (std::size_t at = begin[r] * item; at < end; at += longest) f(at, std::min(longest, end - at));
  };
  Requests requests;
  for (int i = 1; i < size_; ++i) {
    const int from = (rank_ + size_ - i) % size_;
    parts(receive_begin, from,
          [&](std::size_t at, std::size_t n) { requests.receive(*this, in + at, n, from, tag_all_to_all); });
  }
  for (int i = 1; i < size_; ++i) {
    const int to = (rank_ + i) % size_;
    parts(send_begin, to,
          [&](std::size_t at, std::size_t n) { requests.send(*this, out + at, n, to, tag_all_to_all); });
  }
  const auto self = static_cast<std::size_t>(rank_);
  std::copy(out + send_begin[self] * item, out + send_begin[self + 1] * item,
            in + receive_begin[self] * item);
  requests.wait_all();
}

void Requests::send(const Communicator& comm, const void* data, std::size_t bytes, int rank, int tag) {
  requests_.push_back(MPI_REQUEST_NULL);
  check(MPI_Isend(data, count_of(bytes), MPI_BYTE, rank, tag, comm.handle(), &requests_.back()), "MPI_Isend");
}

void Requests::receive(const Communicator& comm, void* data, std::size_t bytes, int rank, int tag) {
  requests_.push_back(MPI_REQUEST_NULL);
  check(MPI_Irecv(data, count_of(bytes), MPI_BYTE, rank, tag, comm.handle(), &requests_.back()), "MPI_Irecv");
}

void Requests::send_unannounced(const Communicator& comm, const void* data, std::size_t bytes, int rank,
                                int tag, std::size_t longest) {
  const auto* from = static_cast<const std::byte*>(data);
  for (; bytes >= longest; bytes -= longest, from += longest) send(comm, from, longest, rank, tag);
  send(comm, from, bytes, rank, tag);
}

void Requests::wait_all() {
  check(MPI_Waitall(count_of(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE), "MPI_Waitall");
  requests_.clear();
}

PersistentRequests::~PersistentRequests() {
  for (MPI_Request& r : requests_) MPI_Request_free(&r);
}

void PersistentRequests::add_send(const Communicator& comm, const double* data, std::size_t n, int rank,
                                  int tag) {
  requests_.push_back(MPI_REQUEST_NULL);
  check(MPI_Send_init(data, count_of(n), MPI_DOUBLE, rank, tag, comm.handle(), &requests_.back()),
        "MPI_Send_init");
}

void PersistentRequests::add_receive(const Communicator& comm, double* data, std::size_t n, int rank,
                                     int tag) {
  requests_.push_back(MPI_REQUEST_NULL);
  check(MPI_Recv_init(data, count_of(n), MPI_DOUBLE, rank, tag, comm.handle(), &requests_.back()),
        "MPI_Recv_init");
}

void PersistentRequests::start(std::size_t i) { check(MPI_Start(&requests_[i]), "MPI_Start"); }

void PersistentRequests::start_all() {
  if (requests_.empty()) return;
  check(MPI_Startall(count_of(requests_.size()), requests_.data()), "MPI_Startall");
}

int PersistentRequests::wait_any() {
  int i = MPI_UNDEFINED;
  check(MPI_Waitany(count_of(requests_.size()), requests_.data(), &i, MPI_STATUS_IGNORE), "MPI_Waitany");
  return i == MPI_UNDEFINED ? -1 : i;
}

void PersistentRequests::wait_all() {
  check(MPI_Waitall(count_of(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE), "MPI_Waitall");
}

}  // namespace mpm::parallel
