#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/st/library/library.hpp"

namespace lineshaft::st {

std::shared_ptr<const SourceFile> read(const std::string& path);
std::shared_ptr<const SourceFile> source(std::string text);

/// One instance of each kind of a library, data blocks bound, without a net.
class Instances {
  public:
    explicit Instances(const Library& library);

    /// All programs, in the order of the source; if there is none, all function blocks.
    void scan(std::int64_t time, std::int64_t interval);

    /// `12 array_bounds` of each that ended with a fault in the last scan.
    std::vector<std::string> faults() const;

    /// The value in the first kind that has a field of that name, in one that is scanned if some
    /// has it; enumerations by their names.
    std::string text(const std::string& field) const;
    /// Whether nothing was written before or behind an instance.
    bool is_guarded() const;
    /// The whole memory of all, the words that guard each included.
    const std::vector<std::vector<std::uint64_t>>& memory() const { return memory_; }
    std::byte* memory(std::size_t kind) { return places_[kind]; }

  private:
    bool is_scanned(const BlockType& kind) const;

    const Library& library_;
    std::vector<std::vector<std::uint64_t>> memory_;
    std::vector<std::byte*> places_;
};

}  // namespace lineshaft::st
