// A right input, and what the reader says when one piece of it is replaced.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene/catalogue.hpp"
#include "core/scene/scene.hpp"
#include "io/input/reader.hpp"

namespace mpm::test {

/// A copper bar; the values are of the kind that a user writes.
inline constexpr std::string_view bar = R"(<?xml version="1.0" encoding="utf-8"?>
<PeneBlast version="1.0">
  <Header><Name value="bar"/></Header>
  <Material name="cu">
    <ReferenceDensity value="8.93e-3"/>
    <StrengthModel type="IsoHarden" Young="117e3" Poisson=".35" Yield0="400" TangMod="100"/>
    <EquationOfState type="Gruneisen" C0="3940" S1="1.49" gamma0="1.96"/>
    <FailureModel type="none"/>
  </Material>
  <WorkPlane name="plane" r0z="0.38"/>
  <Component name="target">
    <Body name="rod" material="cu" type="Block" workPlane="plane">
      <Geometry dp="0.38" x0="0" y0="0" z0="0" lx="3.8" ly="3.8" lz="19"/>
      <InitialVelocity vx="0" vy="0" vz="-190"/>
    </Body>
  </Component>
  <Grid shape="linear">
    <Cell type="regular">
      <XMin value="0" boundary="2"/><XMax value="11.4" boundary="0"/>
      <YMin value="0" boundary="2"/><YMax value="11.4" boundary="0"/>
      <ZMin value="0" boundary="2"/><ZMax value="26.6" boundary="0"/>
      <DCell dx="0.76" dy="0.76" dz="0.76"/>
    </Cell>
  </Grid>
  <Solution><EndTime value="0.08"/></Solution>
</PeneBlast>
)";

/// The beginning of its law, and of that of a rigid bar.
inline constexpr std::string_view law =
    "<StrengthModel type=\"IsoHarden\" Young=\"117e3\" Poisson=\".35\" Yield0=\"400\" TangMod=\"100\"";
inline constexpr std::string_view rigid_law = "<StrengthModel type='Rigid'";
std::string rigid_bar();

/// Laws enough for the bar and its variants, independent of those of `physics`.
const core::Catalogue& small_catalogue();

std::string replaced(std::string_view text, std::string_view from, std::string_view to);

core::Scene parse(std::string_view text, const io::ReadOptions& options = {});

/// The scene of a text with the laws of the program, and its notes.
core::Scene parse(std::string_view text, std::vector<core::Diagnostic>& notes, bool accept_later = false);

/// Its notes without the file's name.
std::vector<std::string> notes_of(std::string_view text, bool accept_later = false);

/// The faults about a text without the file's name; one "ok" when there are none.
std::vector<std::string> faults(std::string_view text, const io::ReadOptions& options = {});

struct Wrong {
  std::string_view from;  ///< piece of the bar's input
  std::string_view to;    ///< what stands there instead
  std::vector<std::string> messages;
};

/// Checks that each of these changes to the bar brings its messages and no others.
void check_faults(const std::vector<Wrong>& table);

/// A folder of its own that is removed again.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
  std::filesystem::path write(std::string_view name, std::string_view bytes) const;

 private:
  std::filesystem::path path_;
};

}  // namespace mpm::test
