#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/machine/machine.hpp"
#include "runtime/model/kept_state.hpp"

namespace lineshaft {

/// Takes over kept blocks into the blocks of a machine, and looks whether it can go on with them
/// whatever their bytes are: each field, what the parameters rest on, what each kind says.
class KeptMemory {
  public:
    /// `now` [ns] is where the machine goes on.
    KeptMemory(Machine& machine, std::int64_t now);

    /// What outlives a scan of a block, into the place of that block.
    void take(const BlockPlace& block, std::byte* place, const std::byte* kept);

    /// Mends a block that was taken when others were not: see BlockType::mend_links.
    void mend(std::size_t block);

    /// When all has been taken: the first block that is not as it may be, `'x' (axis)`; or empty.
    std::string damaged() const;

    /// Whether a place in the memory has room for a value of the type in a field of its type, or is
    /// an input of the program. `published`: where others see it.
    bool is_signal(const std::byte* place, Type type, bool published) const;

  private:
    bool is_valid(std::size_t block) const;
    bool is_unchanged(std::size_t block) const;
    void find_links();
    KeptState state_of(const BlockPlace& block) const;

    Machine& machine_;
    std::int64_t now_;
    BlockMemory fresh_;                  ///< the memory as it was
    std::vector<std::byte*> published_;  ///< of each block, where others see it
    std::vector<std::int64_t> links_;    ///< sorted
};

}  // namespace lineshaft
