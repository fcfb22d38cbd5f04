#pragma once

#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "runtime/model/catalog.hpp"
#include "runtime/st/syntax/lexer.hpp"
#include "runtime/st/syntax/tree.hpp"

namespace lineshaft::st {

/// Which files of the catalogue's libraries a program takes along. A file is taken
///   - for a name of it that the sources use and nobody else has: they declare no type, unit,
///     global variable or value of an enumeration of that name, nor has the catalogue it; the
///     first library that has it is meant; names of a library with a point in its name, and of
///     helpers, which begin with a small letter, are not looked for, nor names in SCL;
///   - for `Util.BLINK`, where `Util` is the library, whatever else has that name;
///   - for USING with its library, and for a name before which a library with a point stands: all;
///   - for a name that a taken file uses.
/// A library whose namespace the sources declare themselves is theirs.
class LibraryNames {
  public:
    explicit LibraryNames(const Catalog& catalog);

    /// Those of a source.
    void note_names(const Tokens& tokens);
    /// Parses the files that are taken for the names that were noted.
    void add_files(Tree& tree, Diagnostics& out);
    /// A file that was taken uses the prelude.
    bool use_standard_source() const { return uses_standard_source_; }

    /// What a file declares for others, in its order: names of types, values of enumerations, units
    /// and global variables, by the lines that they stand in.
    static std::vector<std::string_view> declared_in(const LibraryFile& file);

    struct Index;

  private:
    void note_qualified(const Tokens& tokens, std::size_t at);
    /// `declared` are names that others have, `own` libraries that the sources are themselves.
    void take_named(const NameSet& declared, const NameSet& own);

    const Catalog& catalog_;
    const Index& index_;
    std::set<std::string_view> names_;  ///< as libraries write them
    std::set<const LibraryFile*> taken_;
    bool uses_standard_source_ = false;
};

}  // namespace lineshaft::st
