/// \file
/// The library's version, its only source.
#ifndef TAFONI_VERSION_HPP
#define TAFONI_VERSION_HPP

namespace tafoni {

/// Semantic version: before 1.0 a new minor version may change any interface.
inline constexpr int version_major = 0;
inline constexpr int version_minor = 1;
inline constexpr int version_patch = 0;

/// "major.minor.patch", as written into reports and checkpoints.
inline constexpr char const* version_string = "0.1.0";

}  // namespace tafoni

#endif
