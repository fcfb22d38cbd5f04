#pragma once

#include "runtime/st/check/check.hpp"
#include "runtime/st/check/uses.hpp"
#include "runtime/st/generate/generator.hpp"
#include "runtime/st/library/library.hpp"

namespace lineshaft::st {

/// What sources are compiled to, with all that it refers to: so it is not moved.
struct Compiled {
    std::vector<std::shared_ptr<const SourceFile>> sources;
    std::vector<LibraryReference> libraries, missing_libraries;  ///< that a project refers to
    Tree tree;
    Checked checked;
    Generated generated;

    Compiled() = default;
    ~Compiled();  ///< records what was covered
    Compiled(const Compiled&) = delete;
    Compiled& operator=(const Compiled&) = delete;
};

/// Compiles all `sources` together; of them `tests`, if any, is a file of tests. False with all
/// that is wrong in `out`.
bool compile(Compiled& to, const Catalog& standard, Diagnostics& out, CodeOptions options = {},
             const SourceFile* tests = nullptr);

/// Finds out what the names of all `sources` mean, as far as it can be said, and makes no code.
std::vector<NameUse> understand(Compiled& to, const Catalog& standard,
                                const SourceFile* tests = nullptr);

/// Makes the processor's code of it, where the options want that and nothing is counted.
void make_native(Code& code, const Options& options);

/// A place in what comes with lineshaft is where the user's source calls that, in a scan of `root`
/// that ended so; else it is itself.
Place place_of_user(const Code& code, const std::byte* root, const EndOfScan& end, Place at);

/// Where the last execution on an instance ended with a fault.
FaultPlace fault_of(const Code& code, const std::byte* instance);

/// Where an instance first cut a text short.
std::optional<Mark> cut_of(const Code& code, const std::byte* instance);

/// For check(): assigns the expression to a variable in a program of its own, and runs that.
Evaluated evaluate(Expression& expression);

}  // namespace lineshaft::st
