#pragma once

#include "runtime/st/generate/writing.hpp"

namespace lineshaft::st {

/// The slots that a value of the type takes; lays it out. Of a block only after it is laid out,
/// with all its methods. L0912: more memory than a block may have.
std::uint32_t slots_of(Writing& w, const Type& type);

/// Variables that live for one call only come last, to be initialised in one go.
void lay_out(Writing& w, Routine& block);

/// Those of a variable in its frame.
std::uint32_t slots_in_frame(Writing& w, const Variable& variable);
/// It is given to a method, or else taken from it.
bool is_in_signature(const Variable& variable, bool is_given);

/// What is given to a function or a method comes first. A method's frame is a part of its block's.
void lay_out_call(Writing& w, Routine& routine);

/// Instances among the variables beside the blocks have their places once their blocks are
/// written, which is before who names them: their size is not known earlier.
class GlobalLayout {
  public:
    explicit GlobalLayout(Writing& w);
    /// What can be by now.
    void place_known();
    /// All blocks are written.
    void finish();

  private:
    Writing& w_;
    Type* late_ = nullptr;
    std::vector<Variable*> waiting_ = {};
    std::uint64_t slots_ = 0;
};

}  // namespace lineshaft::st
