#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "runtime/st/library/fields.hpp"
#include "runtime/st/library/test_suite.hpp"

namespace lineshaft::st {

/// Memory to execute routines on, one of a unit and the data blocks, and what assertions in them
/// say. Two may not execute at once what one Compiled has.
class Bench : Witness {
  public:
    /// What an assertion says that does not hold; true: what runs ends with it.
    using Told = std::function<bool(TestResult)>;

    /// Each of `kept` has a block of its own beside the unit.
    Bench(const Compiled& made, const Options& options, const Type& unit, Told told,
          std::span<const KeptReference> kept = {});
    /// On the memory of a machine that runs a scan of the unit, whose time this is.
    Bench(const Compiled& made, const Options& options, std::byte* unit, const Context& context,
          Told told);
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;

    /// Executes a routine on the unit's instance or that of a data block. A fault is a failure; so
    /// is an assertion that ended it.
    TestResult run(const CodeRoutine& routine, std::byte* instance);
    /// On an instance of that block that the unit (-1) or that data block has: an address in it
    /// means the same to all.
    TestResult run_part(const CodeRoutine& routine, const Type& block, int global,
                        std::size_t slot);
    /// Where what ran on the unit ended with a failure, and the calls that ran then.
    std::vector<std::uint64_t> end_of_scan() const;
    /// That again, whatever ran since.
    void end_at(std::span<const std::uint64_t> end);
    /// How long a cycle of the unit's task takes [ns]; 1 ms where it is not set.
    void set_cycle(std::int64_t cycle) { now_.interval = cycle; }
    /// A cycle goes by: the blocks beside the unit, such as axes, are scanned in each millisecond.
    void advance();

    std::byte* unit() { return unit_; }
    std::byte* global(std::size_t number) { return places_[number]; }
    std::int64_t time() const { return now_.time; }
    std::optional<Mark> cut();

  private:
    void add_types(const Type& unit, std::span<const KeptReference> kept);
    std::vector<std::size_t> lay_out(const Type& unit, std::span<const KeptReference> kept);
    TestResult run_on(const CodeRoutine& routine, std::byte* instance, std::uint64_t frame);
    bool ends_at(std::uint64_t instruction, std::uint64_t frame, std::uint64_t depth) override;
    bool let_pass(std::int64_t time, std::int64_t interval) override;

    const Compiled& made_;
    const Options& options_;
    Told told_;
    std::vector<std::uint64_t> memory_;  ///< of the unit, the data blocks and objects, what is kept
    std::vector<std::byte*> places_;
    std::vector<BlockType> sizes_;         ///< of what is no block of the catalogue: its size alone
    std::vector<const BlockType*> types_;  ///< of all that has a place
    std::byte* unit_ = nullptr;
    Context context_;
    std::vector<std::pair<const BlockType*, std::byte*>> objects_;
    Scan now_{0, 1'000'000, 0};
    Scan now_of_objects_{};
    std::unordered_map<const Type*, std::vector<std::uint64_t>> callers_;  ///< of parts that run
    std::byte* root_ = nullptr;  ///< the instance that runs, or the caller of the part that does
    TestResult ended_;           ///< by the last one
};

}  // namespace lineshaft::st
