// Views of one particle and of one block of up to eight: columns by name.
#pragma once

#include "core/particles/columns.hpp"
#include "core/tensor/tensor.hpp"

namespace mpm::core {

/// View of one particle. Value: double, or const double.
template <class Value>
class ParticleOf {
 public:
  ParticleOf(const ColumnLayout& layout, Value* at) : layout_(&layout), at_(at) {}
  Value& operator[](Column c) const { return at_[layout_->offset(c)]; }
  /// Of three consecutive columns.
  Vec3<double> vector(Column first) const {
    Value* x = at_ + layout_->offset(first);
    return {x[0], x[block_lanes], x[2 * block_lanes]};
  }
  /// The i-th column of those that the body carries.
  Value& nth(int i) const { return at_[block_lanes * i]; }
  const ColumnLayout& layout() const { return *layout_; }

 private:
  const ColumnLayout* layout_;
  Value* at_;
};

/// Up to eight particles of one body in one brick, column by column.
template <class Value>
struct ParticleBlockOf {
  int body = 0;
  const ColumnLayout* layout = nullptr;
  Value* data = nullptr;
  int used = 0;  ///< lanes in use

  Value* column(Column c) const { return data + layout->offset(c); }
  ParticleOf<Value> particle(int lane) const { return {*layout, data + lane}; }

  struct Iterator {
    const ColumnLayout* layout;
    Value* at;
    ParticleOf<Value> operator*() const { return {*layout, at}; }
    Iterator& operator++() {
      ++at;
      return *this;
    }
    bool operator==(const Iterator& o) const { return at == o.at; }
  };
  Iterator begin() const { return {layout, data}; }
  Iterator end() const { return {layout, data + used}; }
};

using Particle = ParticleOf<double>;
using ConstParticle = ParticleOf<const double>;
using ParticleBlock = ParticleBlockOf<double>;
using ConstParticleBlock = ParticleBlockOf<const double>;

}  // namespace mpm::core
