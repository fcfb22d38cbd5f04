#pragma once

#include "runtime/st/check/checking.hpp"

namespace lineshaft::st {

/// `x AT %I*`: it is wired from outside. False: it is at an address.
bool is_left_open(const Token& at, Variable& variable);

/// `x AT %QW4 : INT`: the variable is a view of the process image. One at `%I*` is none.
void locate_in_image(Checking& c, Variable& variable, const Declaration& declared);

/// `%QW4` in an expression.
const Type* check_direct(Checking& c, Expression& e);

/// How long each area is. Warns of variables of which none is a part of the other.
void finish_image(Checking& c);

/// What stands at an address, as a variable that nobody can name but by this.
Variable& variable_at(Checking& c, const Token& at, std::string_view name, const Type& type,
                      const ImageAddress& address);

/// The first 1024 bytes of an area, as an array that nobody can name.
Variable& bytes_of_area(Checking& c, const Token& at, ImageAddress::Area area);

// peeks.cpp

/// `PEEK(area := 16#81, dbNumber := 0, byteOffset := i)` takes the byte of the process image, and
/// so do its like and POKE. False: there is none, which was told.
bool take_bytes(Checking& c, Expression*& e, const Routine& called);

// overlays.cpp

/// `view AT other : T` of a routine, whose variables are declared: what each is a view of.
void declare_overlays(Checking& c, Routine& routine);

/// Where no variable has another's bytes: in a structure, among globals.
void refuse_overlay(Checking& c, const Declaration& declared);

/// `e`, which means an overlay, becomes what is seen of the other variable.
const Type* use_overlay(Checking& c, Expression*& e, const Variable& overlay);

}  // namespace lineshaft::st
