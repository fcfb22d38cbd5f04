#pragma once

#include "runtime/st/library/compiled.hpp"

namespace lineshaft::st {

/// What the library TcUnit keeps of the suites and their tests, in the memory of a run.
class SuitesState {
  public:
    /// `globals`: what the first list of globals has, the libraries'.
    SuitesState(const Compiled& made, std::byte* globals);

    /// Whether the program uses the library; else nothing more is asked.
    bool is_there() const { return state_ != nullptr; }

    std::int64_t get(std::string_view name) const;
    void set(std::string_view name, std::int64_t value);

    /// A test at some moment; its number, from 1 on, is that of its place among all.
    struct Test {
        std::int64_t suite = 0;
        std::string name;
        bool finished = false, skipped = false;
    };
    Test test(std::int64_t number) const;

  private:
    std::byte* place(std::string_view name) const;

    const Variable* state_ = nullptr;
    std::byte* globals_;
};

}  // namespace lineshaft::st
