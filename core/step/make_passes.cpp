// The only place where a run's shape functions and transfer are chosen.
#include "core/shape/linear.hpp"
#include "core/step/passes_with.hpp"
#include "core/transfer/flip.hpp"

namespace mpm::core {

std::unique_ptr<Passes> make_passes(Model& model, NodeHalo& halo) {
  return std::make_unique<PassesWith<Linear, Flip>>(model, halo);
}

ColumnSet transfer_columns(const Scene&) { return Flip::columns(); }

NodeBlockShape node_block_of(const Scene&) { return Linear::node_block; }

NodeArraySet node_arrays_of(const Scene& scene, bool conducts) {
  NodeArraySet arrays{NodeArray::first};
  if (conducts || scene.solution.scheme != Scheme::usl) arrays.add(NodeArray::second);
  return arrays;
}

}  // namespace mpm::core
