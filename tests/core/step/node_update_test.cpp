// Nodes: sums over the bricks that share them, the equation of motion, and every boundary on every face.
#include "core/step/node_update.hpp"

#include <cstring>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include <catch2/catch.hpp>

#include "core/step/shared_nodes.hpp"

using namespace mpm::core;

namespace {

using Node = std::tuple<std::int64_t, std::int64_t, std::int64_t>;

constexpr NodeBlockShape shapes[] = {{0, 0}, {1, 0}, {1, 1}};

GridGeometry geometry_of(std::array<std::int64_t, 3> cells) {
  GridGeometry g;
  g.cell = g.inverse_cell = {1, 1, 1};
  g.cells = cells;
  return g;
}

/// f(number in the brick's array, node of the grid) for the nodes of a brick's array.
template <class F>
void for_each_node(const NodeBlockShape& shape, BrickCoord b, F f) {
  for (int k = shape.lowest(); k <= shape.highest(); ++k) {
    for (int j = shape.lowest(); j <= shape.highest(); ++j) {
      for (int i = shape.lowest(); i <= shape.highest(); ++i) {
        f(shape.index(i, j, k), Node{brick_cells * b.x + i, brick_cells * b.y + j, brick_cells * b.z + k});
      }
    }
  }
}

/// Random contributions of all slots, masses not negative.
void fill(BrickGrid& grid, NodeArray of, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const int width = record_doubles(of);
  for (Slot s = 0; s < grid.owned(); ++s) {
    for (int i = 0; i < width * grid.shape().nodes(); ++i) {
      const double x = unit(random);
      grid.contributions(of, s)[i] = i % width == 3 ? std::abs(x) : x * std::pow(10.0, 8 * x);
    }
  }
}

using Record = std::array<double, node_doubles>;

/// The record of every node of the grid after work(slot, records); every copy must have the same bits.
template <class W>
std::map<Node, Record> agreed(const BrickGrid& grid, W work) {
  std::map<Node, Record> nodes;
  std::vector<double> records(static_cast<std::size_t>(node_doubles * grid.shape().nodes()));
  int different = 0;
  for (Slot s = 0; s < grid.owned(); ++s) {
    work(s, records.data());
    for_each_node(grid.shape(), grid.brick(s).coord, [&](int n, const Node& node) {
      Record r;
      std::memcpy(r.data(), records.data() + node_doubles * n, sizeof r);
      const auto [at, is_new] = nodes.emplace(node, r);
      different += !is_new && std::memcmp(at->second.data(), r.data(), sizeof r) != 0;
    });
  }
  CHECK(different == 0);
  return nodes;
}

std::vector<BrickCoord> random_bricks(std::mt19937& random, unsigned of_eight) {
  std::vector<BrickCoord> bricks{{0, 0, 0}, {1, 1, 1}};  // a diagonal pair always
  for (int i = 0; i < 64; ++i) {
    const BrickCoord b{i % 4, i / 4 % 4, i / 16};
    if (random() % 8 < of_eight && b != bricks[0] && b != bricks[1]) bricks.push_back(b);
  }
  return bricks;
}

}  // namespace

TEST_CASE("Every copy of a node has the same sum and the same motion, to the last bit") {
  std::mt19937 random(21);
  for (const NodeBlockShape shape : shapes) {
    for (unsigned density = 0; density <= 8; ++density) {
      GridGeometry g = geometry_of({14, 13, 16});
      g.boundary = {Boundary::fixed, Boundary::rigid_wall, Boundary::symmetry,
                    Boundary::free,  Boundary::rigid_wall, Boundary::symmetry};
      BrickGrid grid(g, shape);
      grid.reset(random_bricks(random, density), {});
      fill(grid, NodeArray::first, random);
      fill(grid, NodeArray::second, random);
      const SharedNodes shared(grid.shape());
      NodeForces forces;
      forces.gravity = {1, -2, 3};
      forces.damping = 0.1;
      forces.strain_mass_floor = 0.5;
      std::vector<double> sums(static_cast<std::size_t>(node_doubles * grid.shape().nodes()));
      const auto nodes = agreed(grid, [&](Slot s, double* records) {
        const BoundaryFaces faces(g, grid.shape(), grid.brick(s).coord);
        sum_contributions<NodeArray::first>(grid, shared, s, records);
        update_nodes(forces, 0.01, 1e-3, faces, shared.summed(), records);
        sum_contributions<NodeArray::second>(grid, shared, s, sums.data());
        second_velocities(0, sums.data(), records, faces, shared.summed(), records);
      });
      CHECK(nodes.size() >= 125);
    }
  }
}

TEST_CASE("A node's sum is that of all bricks which hold it") {
  std::mt19937 random(22);
  for (const NodeBlockShape shape : shapes) {
    BrickGrid grid(geometry_of({16, 16, 16}), shape);
    grid.reset(random_bricks(random, 4), {});
    fill(grid, NodeArray::first, random);
    fill(grid, NodeArray::second, random);
    std::map<Node, Record> first, second, size;
    for (Slot s = 0; s < grid.owned(); ++s) {
      for_each_node(grid.shape(), grid.brick(s).coord, [&](int n, const Node& node) {
        for (std::size_t c = 0; c < node_doubles; ++c) {
          const double x = grid.contributions(NodeArray::first, s)[node_doubles * n + static_cast<int>(c)];
          first[node][c] += x;
          size[node][c] += std::abs(x);
          if (c < 4) second[node][c] += grid.contributions(NodeArray::second, s)[4 * n + static_cast<int>(c)];
        }
      });
    }
    const SharedNodes shared(grid.shape());
    // At most eight addends, in another order: round-off of their sizes.
    double worst = 0;
    for (const auto& [node, r] :
         agreed(grid, [&](Slot s, double*r) { sum_contributions<NodeArray::first>(grid, shared, s, r); })) {
      for (std::size_t c = 0; c < node_doubles; ++c)
        worst = std::max(worst, std::abs(r[c] - first[node][c]) / size[node][c]);
    }
    CHECK(worst < 4e-15);
    const auto two = agreed(grid, [&](Slot s, double* r) {
      std::fill_n(r, node_doubles * grid.shape().nodes(), 7.0);
      sum_contributions<NodeArray::second>(grid, shared, s, r);
    });
    worst = 0;
    bool rest_kept = true;
    for (const auto& [node, r] : two) {
      for (std::size_t c = 0; c < 4; ++c) worst = std::max(worst, std::abs(r[c] - second[node][c]));
      for (std::size_t c = 4; c < node_doubles; ++c) rest_kept = rest_kept && r[c] == 7;
    }
    CHECK(worst < 1e8 * 4e-15);  // of the largest momentum
    CHECK(rest_kept);
  }
}

TEST_CASE("Sums that are carried from a brick to the next along x have the same bits") {
  std::mt19937 random(23);
  for (const NodeBlockShape shape : shapes) {
    for (unsigned density = 1; density <= 8; ++density) {
      BrickGrid grid(geometry_of({16, 16, 16}), shape);
      grid.reset(random_bricks(random, density), {});
      // DDMP maps momenta to the smaller block.
      const SharedNodes whole(shape),
          momenta(shape, shape == NodeBlockShape{1, 1} ? NodeBlockShape{} : shape);
      const auto check = [&]<NodeArray of>(const SharedNodes& shared) {
        fill(grid, of, random);
        CarriedSums<of> carried;
        std::vector<double> plain(static_cast<std::size_t>(node_doubles * shape.nodes())), given = plain;
        int different = 0;
        for (Slot s = 0; s < grid.owned(); ++s) {
          if (random() % 16 == 0) continue;  // another thread's
          sum_contributions<of>(grid, shared, s, plain.data());
          sum_contributions(grid, shared, s, carried, given.data());
          different += std::memcmp(plain.data(), given.data(), sizeof(double) * plain.size()) != 0;
        }
        CHECK(different == 0);
        carried.forget();
        CHECK_FALSE(carried.begins(grid, 1));
      };
      check.operator()<NodeArray::first>(whole);
      check.operator()<NodeArray::second>(momenta);
      // And finds the motion of that block alone.
      if (momenta.reached() != shape)
        check.operator()<NodeArray::first>(SharedNodes(shape, shape, momenta.reached()));
    }
  }
}

TEST_CASE("Sums of a smaller block of nodes have the bits of all sums, and leave the other nodes alone") {
  std::mt19937 random(29);
  const NodeBlockShape shape{1, 1}, inner;
  const SharedNodes all(shape), some(shape, shape, inner);
  std::set<int> wanted;
  some.summed().for_each([&](int first, int count) {
    for (int n = first; n < first + count; ++n) wanted.insert(n);
  });
  CHECK(wanted.size() == 125);
  CHECK(some.summed().nodes() == 125);
  BrickGrid grid(geometry_of({16, 16, 16}), shape);
  grid.reset(random_bricks(random, 4), {});
  fill(grid, NodeArray::first, random);
  const auto count = static_cast<std::size_t>(node_doubles * shape.nodes());
  for (Slot s = 0; s < grid.owned(); ++s) {
    std::vector<double> whole(count), part(count, 7.0);
    sum_contributions<NodeArray::first>(grid, all, s, whole.data());
    sum_contributions<NodeArray::first>(grid, some, s, part.data());
    int different = 0;
    for (int n = 0; n < shape.nodes(); ++n) {
      for (int c = 0; c < node_doubles; ++c) {
        const auto at = static_cast<std::size_t>(node_doubles * n + c);
        different += part[at] != (wanted.contains(n) ? whole[at] : 7.0);
      }
    }
    CHECK(different == 0);
  }
}

TEST_CASE(
    "A free node moves by (f/m + g - c v) dt, of which its increment has (f/m + g) dt; one at the cutoff or "
    "below does not exist") {
  NodeForces forces;
  forces.gravity = {1, 2, -8};
  forces.damping = 0.5;
  forces.strain_mass_floor = 4;
  const NodeBlockShape shape;
  const BoundaryFaces faces(geometry_of({8, 8, 8}), shape, {0, 0, 0});
  CHECK(faces.none());
  std::vector<double> records(static_cast<std::size_t>(node_doubles * shape.nodes()));
  const Record heavy{16, -8, 4, 8, 32, 8, -16, 0}, light{4, 0, 0, 2, 2, 0, 0, 0},
      cut{1, 1, 1, 0.125, 1e9, 1, 1, 0};
  std::copy(heavy.begin(), heavy.end(), records.begin());
  std::copy(light.begin(), light.end(), records.begin() + node_doubles);
  std::copy(cut.begin(), cut.end(), records.begin() + 2 * node_doubles);
  update_nodes(forces, 0.25, 0.125, faces, {shape, shape}, records.data());
  const auto record = [&](int n) {
    Record r;
    std::copy_n(records.begin() + node_doubles * n, node_doubles, r.begin());
    return r;
  };
  // v = (2, -1, 0.5), f/m + g = (4 + 1, 1 + 2, -2 - 8), c dt = 1/8
  CHECK(record(0) == Record{3, -0.125, -2.0625, 8, 1.25, 0.75, -2.5, 0});
  CHECK(record(1)[3] == 2);
  CHECK(record(1)[7] == 0.5);  // half of the floor
  CHECK(record(2) == Record{});
  CHECK(record(3) == Record{});
}

TEST_CASE("Every boundary holds what it should on every face, also where the last brick is partial") {
  for (const std::array<std::int64_t, 3> cells :
       {std::array<std::int64_t, 3>{8, 8, 8}, {6, 5, 7}, {3, 4, 1}}) {
    for (int face = 0; face < 6; ++face) {
      for (const Boundary boundary : {Boundary::fixed, Boundary::symmetry, Boundary::rigid_wall}) {
        INFO("cells " << cells[0] << ", face " << face << ", boundary " << static_cast<int>(boundary));
        GridGeometry g = geometry_of(cells);
        g.boundary[static_cast<std::size_t>(face)] = boundary;
        BrickGrid grid(g);
        std::vector<BrickCoord> bricks;
        for (int i = 0; i < 8; ++i) {
          const BrickCoord b{i % 2, i / 2 % 2, i / 4};
          if (4 * b.x < cells[0] && 4 * b.y < cells[1] && 4 * b.z < cells[2]) bricks.push_back(b);
        }
        grid.reset(bricks, {});
        std::mt19937 random(31);
        fill(grid, NodeArray::first, random);
        fill(grid, NodeArray::second, random);
        const SharedNodes shared(grid.shape());
        const double dt = 0.5;
        std::vector<double> sums(static_cast<std::size_t>(node_doubles * grid.shape().nodes()));
        const auto before =
            agreed(grid, [&](Slot s, double* r) { sum_contributions<NodeArray::first>(grid, shared, s, r); });
        const auto second = agreed(
            grid, [&](Slot s, double* r) { sum_contributions<NodeArray::second>(grid, shared, s, r); });
        const auto moved = [&](Slot s, double* r) {
          sum_contributions<NodeArray::first>(grid, shared, s, r);
          update_nodes({}, dt, 0, BoundaryFaces(g, grid.shape(), grid.brick(s).coord), shared.summed(), r);
        };
        const auto after = agreed(grid, moved);
        const auto mapped = agreed(grid, [&](Slot s, double* r) {
          moved(s, r);
          sum_contributions<NodeArray::second>(grid, shared, s, sums.data());
          second_velocities(0, sums.data(), r, BoundaryFaces(g, grid.shape(), grid.brick(s).coord),
                            shared.summed(), r);
        });
        const auto axis = static_cast<std::size_t>(face / 2);
        const double outward = face % 2 == 0 ? -1 : 1;
        int wrong = 0, held = 0;
        for (const auto& [node, r] : after) {
          const std::int64_t at[3] = {std::get<0>(node), std::get<1>(node), std::get<2>(node)};
          if (at[0] > cells[0] || at[1] > cells[1] || at[2] > cells[2]) continue;  // no particle touches it
          const bool on_face = at[axis] == (face % 2 == 0 ? 0 : cells[axis]);
          const Record& b = before.at(node);
          for (std::size_t a = 0; a < 3; ++a) {
            const double v = (b[a] + dt * b[4 + a]) / b[3], w = second.at(node)[a] / b[3];
            const auto stops = [&](double velocity) {
              if (!on_face) return false;
              return boundary == Boundary::fixed ||
                     (a == axis && (boundary == Boundary::symmetry || outward * velocity > 0));
            };
            // A rigid wall bears no tension, and takes a part of the velocity of a node that moves away from
            // it; else particles keep their velocity.
            double reaction = 0;
            if (boundary == Boundary::rigid_wall)
              reaction = outward * b[a] < 0 ? outward * b[a] * b[a] / (b[3] * std::abs(dt * b[4 + a]))
                                            : outward * std::min(0.0, outward * dt * b[4 + a] / b[3]);
            const double size = std::abs(b[a] / b[3]) + std::abs(dt * b[4 + a] / b[3]);
            wrong += !(std::abs(r[a] - (stops(v) ? 0 : v)) <= 1e-14 * size);
            wrong += !(std::abs(r[4 + a] - (stops(v) ? reaction : dt * b[4 + a] / b[3])) <= 1e-14 * size);
            wrong += stops(v) && r[a] != 0;
            // A node that is stopped strains nobody, wherever the second map would send it.
            const double strains = stops(v) || stops(w) ? 0 : w;
            wrong += !(std::abs(mapped.at(node)[4 + a] - strains) <= 1e-14 * std::abs(w));
            held += stops(v);
          }
        }
        CHECK(wrong == 0);
        CHECK(held > 0);
      }
    }
  }
}

TEST_CASE("A node block that a neighbourhood of 27 bricks cannot serve is refused") {
  for (const NodeBlockShape shape : shapes) CHECK_NOTHROW(SharedNodes(shape));
  // With two layers, node -2 of a brick is node 6 of the brick two further down, which is no neighbour.
  for (const int layers : {-1, 2, 3, 5}) {
    for (const NodeBlockShape shape : {NodeBlockShape{layers, 0}, NodeBlockShape{0, layers}}) {
      CHECK_THROWS_AS(SharedNodes(shape), std::logic_error);
      CHECK_THROWS_AS(BrickGrid(geometry_of({16, 16, 16}), shape), std::logic_error);
    }
  }
}

TEST_CASE("What is prefetched for a brick's sums are the cache lines that they read, each once") {
  // Cache lines of 8 doubles, from the first brick's point of view: its neighbour's offset, line.
  using Line = std::tuple<std::int64_t, std::int64_t, std::int64_t, int>;
  const auto line = [](const SharedNodes::Share& s, int width) {
    const BrickCoord d = neighbour_offset(s.neighbour);
    return Line{d.x, d.y, d.z, s.node * width / 8};
  };
  for (const NodeBlockShape shape : shapes) {
    for (const NodeBlockShape reached : {NodeBlockShape{}, shape}) {
      const SharedNodes shared(shape, reached);
      for (const int width : {4, 8}) {
        std::set<Line> read, read_before;  // by the brick's sums, and by its lower neighbour's
        shared.for_each_node([&](int, auto shares) {
          for (const SharedNodes::Share& s : shares) {
            read.insert(line(s, width));
            const auto [x, y, z, number] = line(s, width);
            read_before.insert({x - 1, y, z, number});
          }
        });
        const auto prefetched = [&](bool after_lower_x) {
          std::set<Line> found;
          for (const SharedNodes::Share& s : shared.lines(width, after_lower_x)) found.insert(line(s, width));
          return found;
        };
        CHECK(prefetched(false) == read);
        if (width == 8) CHECK(shared.lines(width, false).size() == read.size());
        const std::set<Line> fresh = prefetched(true);
        CHECK(fresh.size() < read.size());
        for (const Line& l : read) CHECK((fresh.contains(l) || read_before.contains(l)));
      }
    }
  }
}
