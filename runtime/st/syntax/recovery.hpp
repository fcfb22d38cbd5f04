#pragma once

#include <span>

#include "runtime/source/codes.hpp"
#include "runtime/st/syntax/parsing.hpp"

/// What is told of a mistake, and where reading goes on after it.
namespace lineshaft::st {

/// Tells a mistake in what is being declared, and reading goes on.
void tell(Parsing& p, const char* code, Place place, std::string message, std::string help = {});

/// Nothing more is told until the parser has found its feet again.
void fail(Parsing& p, const char* code, Place place, std::string message, std::string help = {});

/// Fails with what is due here, unless that was told already.
void expected(Parsing& p, std::string_view what, std::string_view where = {});

/// Takes a word; one that is missing is told. False: it is not there.
bool expect(Parsing& p, Word word, std::string_view where = {});

/// Takes a name; what stands there instead is told, and given back.
Token expect_name(Parsing& p, std::string_view what);

/// Takes the end of a block. One that is missing is told once, for the innermost. False: it is not
/// there.
bool close(Parsing& p, Word end, const Token& opener);

/// Takes a ';'. Where the next thing begins a line or ends a block, only that is missing.
void end_statement(Parsing& p);

/// Where a name cannot stand: it is told as one of the words that is spelt wrong, and becomes that.
bool respell(Parsing& p, std::span<const Word> words);

/// What follows a name can follow neither a variable nor a call.
bool at_doomed_name(const Cursor& p);

/// A statement begins or ends that can belong to none of the one that is being read.
bool at_end_of_statements(const Cursor& p);

/// A value of the CASE around stands within a statement, whose end is missing.
bool at_label_of_case(const Parsing& p);

/// What is here, as a message shows it.
std::string found(const Cursor& p);

void skip_line(Parsing& p);
/// Behind the next ';', or before what ends a block or begins another declaration.
void skip_declaration(Parsing& p);
/// Behind the next ';', or before what begins or ends a block.
void skip_to_statement(Parsing& p);
void skip_past(Parsing& p, Word end);

/// What is read by `read` is lost, where it has a mistake, and its names are noted.
void lose_if_wrong(Parsing& p, void (*read)(Parsing&));

}  // namespace lineshaft::st
