#pragma once
// Layers whose thickness grows by a constant factor per layer, exactly from `bottom` to `top`. Their number
// is the one that fits the height best; as with a block, a stack of whole layers is longer or shorter than
// the height by up to half a layer. With bottom = top this is the uniform stack of round(height/spacing)
// layers.

namespace mpm::core {

class Grading {
 public:
  /// All > 0. A height below one spacing gives a single layer of the geometric mean's thickness.
  Grading(double bottom, double top, double height);

  bool uniform() const { return log_ratio_ == 0; }
  double layers() const { return layers_; }  ///< integer of any size, >= 1
  double thickness(double k) const;          ///< of layer k, counted from 0
  double lower(double k) const;              ///< height of layer k's lower face; k = layers: of the top

 private:
  double first_;
  double layers_ = 1;
  double log_ratio_ = 0;  ///< logarithm of the factor
};

}  // namespace mpm::core
