/// \file
/// What a run does with a checkpoint of its own that was damaged.
#ifndef TAFONI_TESTS_FUZZ_DAMAGED_CHECKPOINT_HPP
#define TAFONI_TESTS_FUZZ_DAMAGED_CHECKPOINT_HPP

#include "check_mesh_file.hpp"
#include "reliability/cases.hpp"

#include <tafoni/core/error.hpp>

#include <cstddef>
#include <cstdint>

namespace tafoni_test {

/// It is refused or is a state; nothing else happens either way. Up to three bits are turned, or bytes are cut off.
template <class Run>
void resume_damaged(Run& run, choices& c) {
    auto saved = run.checkpoint();
    auto const intact = saved;
    for (std::uint64_t k = c.below(4); k-- > 0;) saved[c.below(saved.size())] ^= std::byte{1} << static_cast<int>(c.below(8));
    if (c.chance(0.2)) saved.resize(c.below(saved.size()));
    try {
        run.resume(saved);
    } catch (tafoni::io_error const&) {
        require(run.checkpoint() == intact, "a refused checkpoint changes nothing");
    }
}

}  // namespace tafoni_test

#endif
