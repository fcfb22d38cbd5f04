#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/model/catalog.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::st {

/// What the files of vendors' libraries declare, by the lines that it stands in.
struct LibraryIndex {
    /// A value of enumerations.
    struct Value {
        NameSet libraries, enumerations;  ///< that have it
    };

    NameMap<std::vector<const LibraryFile*>> by_name;  ///< those that are looked for
    NameMap<Value> values;
    NameMap<const LibraryFile*> by_full_name;
    NameMap<const LibraryFile*> of_siemens;  ///< that Siemens' sources name without their library
    NameSet of_catalog;  ///< names that are not looked for unless their library is taken
    NameMap<std::vector<const LibraryFile*>> libraries;
    NameSet firsts;  ///< what the libraries' names begin with, up to a point
    std::deque<std::string> full_names;
};

/// That of a catalogue's files, which is made once. For any thread.
const LibraryIndex& index_of(const Catalog& catalog);

/// What a file declares for others, in its order: names of types, values of enumerations, units and
/// global variables, by the lines that they stand in.
std::vector<std::string_view> declared_in(const LibraryFile& file);

/// The words of a block, or of a structure, of a file: among them its pins, or members. Empty where
/// it is none, or has a base, whose parts stand elsewhere.
NameSet words_of(const LibraryFile& file, std::string_view name);

}  // namespace lineshaft::st
