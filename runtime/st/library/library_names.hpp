#pragma once

#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

#include "runtime/model/catalog.hpp"
#include "runtime/model/library_reference.hpp"
#include "runtime/st/library/library_index.hpp"
#include "runtime/st/syntax/lexer.hpp"
#include "runtime/st/syntax/tree.hpp"

namespace lineshaft::st {

/// Which files of the catalogue's libraries a program takes along. A file is taken
///   - for a name of it that the sources use and nobody else has: they declare no type, unit,
///     global variable or value of an enumeration of that name, nor has the catalogue it;
///   - for a name that the catalogue has, too, if something else of that library is taken, or of
///     SoftMotion's, if a source of CODESYS names its axis, AXIS_REF_SM3, or if it
///     stands in a source in TwinCAT's dialect, or in a file of Automation Studio's, and the
///     library is one of its, or if the sources name pins of it that the catalogue's block has not;
///   - for `EXTENDS TON` and its like in CODESYS and TwinCAT: `extended_TON`;
///   - for `Util.BLINK`, where `Util` is the library, whatever else has that name;
///   - for USING with its library, and for a name before which a library that is not open stands:
///   all;
///   - for a name in SCL that Siemens' motion library has, unless the sources name more pins of it
///     that the catalogue's block has;
///   - for a name that a taken file uses: of its own library, if that has it.
/// Where several libraries have a name, the one is meant whose block of that name has most of the
/// pins, or members, that the sources name of it, then one that is taken anyway, then the first; of
/// those alone that the project refers to, where there is one. A block that has nothing of what
/// they name of theirs is not meant, nor SoftMotion's in a file of TwinCAT's, nor one that has less
/// than half of it where the project refers to other libraries, of which some are not here. Names
/// of a library that is not open, and of helpers, which begin with a small letter, are not looked
/// for, nor other names in SCL, nor what is the name of a variable of the sources, or of the
/// library's file that is read. A value of an enumeration, named alone, is looked for in those
/// libraries alone that the project refers to, or of which something else is taken, or where it is
/// given to a pin of a block that libraries have (`BufferMode := Buffered`); in TwinCAT's files
/// without a project in all `Tc2_`, in those of Automation Studio in all of B&R. A library whose
/// namespace the sources declare themselves is theirs.
class LibraryNames {
  public:
    /// `references` are those that a project has to libraries that are here, `misses_some`: it has
    /// more.
    LibraryNames(const Catalog& catalog, const std::vector<LibraryReference>& references,
                 bool misses_some = false);

    /// Those that a source says.
    void note_libraries(const Tokens& tokens);
    /// Parses the files that are taken for what the sources of the tree use.
    void add_files(Tree& tree, Diagnostics& out);
    /// A file that was taken uses the prelude.
    bool use_standard_source() const { return uses_standard_source_; }

  private:
    void note(const Token& name);
    void note_extended(const Token& name);
    void note_names(const Tree& tree);
    void note_qualified(const Tokens& tokens, std::size_t at);
    void note_pins(const Tree& tree);
    void note_pin(std::string_view block, const Argument& argument);
    bool is_hidden(const LibraryFile& file, std::string_view name) const;
    std::string_view block_of(const Declaration& declared) const;
    std::optional<std::size_t> pins_of(const LibraryFile& file, std::string_view name) const;
    bool is_another(const LibraryFile& file, std::string_view name) const;
    std::size_t pins_of_catalog(std::string_view name) const;
    bool names_values_of_plcopen() const;
    const LibraryFile* choose(std::string_view name) const;
    void take(const LibraryFile& file);
    void take_said();
    void take_named();
    void read(const LibraryFile& file, Tree& tree, Diagnostics& out);

    const Catalog& catalog_;
    const LibraryIndex& index_;
    NameSet references_;
    bool misses_some_;
    std::size_t types_ = 0, pous_ = 0, expressions_ = 0,
                declarations_ = 0;  ///< that were looked at
    std::set<std::string_view> names_, of_twincat_, of_matiec_, of_mapp_, of_siemens_, of_studio_,
        of_libraries_;                          ///< as libraries write them
    NameSet given_;                             ///< to pins of blocks that libraries have
    std::map<std::string_view, NameSet> pins_;  ///< that are named of what several libraries have
    std::set<std::string_view> said_;           ///< libraries, and names in full
    std::string_view reading_;                  ///< the library whose file is looked at
    std::set<std::string_view> taken_libraries_;
    std::set<const LibraryFile*> taken_;
    NameSet own_;  ///< libraries that the sources are themselves
    bool uses_standard_source_ = false;
};

}  // namespace lineshaft::st
