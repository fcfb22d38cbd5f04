#pragma once

#include <span>
#include <unordered_map>

#include "runtime/model/library_reference.hpp"
#include "runtime/st/code/machine.hpp"
#include "runtime/st/types/types.hpp"

namespace lineshaft::st {

/// What the sources mean: names resolved, types known, conversions put in, constants folded.
struct Checked {
    std::deque<Type> types;
    std::deque<Routine> routines;    ///< methods included
    std::deque<Variable> variables;  ///< of structures, data blocks and the catalogue
    std::vector<Global> globals;     ///< `VAR_GLOBAL` and data blocks, by number
    std::vector<Routine*> order;     ///< each behind all that it calls or holds
    bool has_references = false;     ///< some variable is one, or one is made
    bool refers_to_in_outs = false;  ///< to what a VAR_IN_OUT is given
    std::deque<std::string> names;   ///< of variables that no source declares
    bool dispatches = false;         ///< calls find routines by instances
    /// What the program's addresses that become numbers stand in (`code/addresses.hpp`), or null.
    Variable *numbered = nullptr, *numbers = nullptr;
    Image image = {};                                 ///< the process image
    bool is_referred[Image::parts] = {};              ///< of it: pointers go beyond what is named
    const Type* bytes_of_image = nullptr;             ///< as pointers see them; null: none does
    std::unordered_set<const Source*> foreign_users;  ///< that have names of libraries not here
    /// Variables of IEC_TIMER, and what calls make them; null: not always the same.
    std::unordered_map<const Variable*, const BlockType*> called_as = {};
};

/// What an instance, or the array that it is an element of, is declared as.
const Variable* variable_of_instance(const Expression& instance);

struct NameUse;

/// What an expression comes to, or the fault that it ends with.
struct Evaluated {
    Fault fault = Fault::none;
    Constant value = {};
};

/// The value of an expression with its type, of constants, operators, conversions and functions of
/// the standard alone: the bits are to be those of a scan, so the machine does it.
using Evaluate = Evaluated (*)(Expression&);

/// Checks `tree` and notes in it what it found. With a mistake in `out` the result is of no use,
/// but to who asks what names mean: `uses`, if it is there, gets what was found.
///   L0904  a name that is not declared     L0905  a type that does not fit
///   L0906  a conversion that may lose      L0907  wrong arguments
///   L0908  a value out of range            L0909  declared twice
///   L0910  not to be assigned              L0911  a recursion
///   L0913  not a constant                  L0914  a statement in a wrong place
///   L0921  warning: never used             L0922  warning: never reached
///   L0923  warning: an argument not taken
///   L0924  warning: a block assigns its own input
///   L0925  warning: a step without a way out
///   L0926  warning: two variables at one address
///   L0927  names that may be of `missing`, libraries that a project refers to
Checked check(Tree& tree, const Catalog& catalog, Evaluate evaluate, Diagnostics& out,
              std::span<const LibraryReference> missing = {}, std::vector<NameUse>* uses = nullptr);

}  // namespace lineshaft::st
