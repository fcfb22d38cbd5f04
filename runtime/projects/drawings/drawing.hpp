#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/projects/xml.hpp"

namespace lineshaft::projects {

enum class Drawn : std::uint8_t {
    contact,
    coil,
    in_variable,
    out_variable,
    in_out_variable,
    block,
    label,
    jump,
    return_,
    connector,
    continuation,
    left_rail,
    right_rail,
    transition  ///< of a chart, what leads to its condition
};

/// A line that comes from an element's output.
struct Line {
    std::size_t from = 0;  ///< in Drawing::elements
    std::string pin;       ///< of a block; empty: its only or first one
};

enum class Edge : std::uint8_t { none, rising, falling };
enum class Storage : std::uint8_t { none, set, reset };
/// Whose order of evaluation a drawing has: that of CODESYS' networks, or that of MatIEC's editors
/// of 2024 and later, or of those before.
enum class DrawnOrder : std::uint8_t { networks, document, position };

/// Where lines end: several of them are a wired OR.
struct Pin {
    pugi::xml_node node = {};  ///< that has `formalParameter`, or of the element itself
    std::string name = {};
    bool is_negated = false;
    Edge edge = Edge::none;
    pugi::xml_node expression = {};  ///< what CODESYS has beside a pin instead of a line
    std::vector<Line> lines = {};
};

struct Element {
    Drawn kind = Drawn::contact;
    pugi::xml_node node;
    std::string id;          ///< `localId`
    std::int64_t order = 0;  ///< `executionOrderId`; 0: by its position
    double x = 0, y = 0;
    std::size_t network = 0;    ///< from 1 on, from top to bottom
    std::size_t lines_out = 0;  ///< that begin here
    std::vector<Pin> inputs = {}, in_outs = {},
                     outputs = {};  ///< but for blocks, one input at most
};

/// A body that is drawn: elements, and lines between them.
struct Drawing {
    std::vector<Element> elements;  ///< as they stand in the file
    /// Elements in the order of evaluation, but that what comes from others waits for these: by
    /// `executionOrderId`, then networks from top to bottom, and elements in them likewise, then
    /// from left to right. Jumps and returns come last in their networks. DrawnOrder::document: by
    /// `executionOrderId` of boxes and variables, then coils and variables as they stand in the
    /// file, then boxes. DrawnOrder::position: likewise, but from top to bottom, what is less than
    /// 10 apart from left to right. With jumps, which those editors do not have, as above.
    std::vector<std::size_t> order;
};

/// Reads `<FBD>`, `<LD>` or what an `<SFC>` has of their elements. What is none of a network, and
/// lines that come from nowhere, are told.
Drawing read_drawing(const XmlFile& file, pugi::xml_node body, Diagnostics& out, DrawnOrder order);

/// `contact`: the word for it in messages.
std::string_view word_of(Drawn kind);

}  // namespace lineshaft::projects
