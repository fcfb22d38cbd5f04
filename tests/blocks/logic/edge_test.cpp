#include "blocks/logic/edge.hpp"

#include <catch2/catch.hpp>

#include "tests/blocks/logic/scan_table.hpp"

using namespace lineshaft::test;

TEST_CASE("r_trig gives one pulse per rising edge") {
    check_tables("r_trig", Calls::once,
                 {
                     {"false at first", "clk | q \n 0 | 0 \n 0 | 0 \n 1 | 1 \n 1 | 0"},
                     {"true at the first scan", "clk | q \n 1 | 1 \n 1 | 0 \n 1 | 0"},
                     {"true for one scan", "clk | q \n 0 | 0 \n 1 | 1 \n 0 | 0 \n 0 | 0"},
                     {"every other scan", "clk | q \n 1 | 1 \n 0 | 0 \n 1 | 1 \n 0 | 0 \n 1 | 1"},
                     {"no pulse when it falls", "clk | q \n 1 | 1 \n 1 | 0 \n 0 | 0 \n 0 | 0"},
                     {"an edge after a pause", "clk | q \n 1 | 1 \n 0 | 0 \n 0 | 0 \n 1 | 1"},
                     {"never true", "clk | q \n 0 | 0 \n 0 | 0 \n 0 | 0"},
                     {"two scans at one instant after 100 days",
                      "time clk | q \n 2400h 0 | 0 \n 2400h 1 | 1 \n 2400h 1 | 0 \n 2401h 1 | 0"},
                 });
}

TEST_CASE("f_trig gives one pulse per falling edge") {
    check_tables(
        "f_trig", Calls::once,
        {
            {"true at first", "clk | q \n 1 | 0 \n 1 | 0 \n 0 | 1 \n 0 | 0"},
            {"false at the first scan", "clk | q \n 0 | 1 \n 0 | 0 \n 0 | 0"},
            {"false for one scan", "clk | q \n 1 | 0 \n 0 | 1 \n 1 | 0 \n 1 | 0"},
            {"every other scan", "clk | q \n 1 | 0 \n 0 | 1 \n 1 | 0 \n 0 | 1 \n 1 | 0"},
            {"no pulse when it rises", "clk | q \n 0 | 1 \n 0 | 0 \n 1 | 0 \n 1 | 0"},
            {"an edge after a pause", "clk | q \n 1 | 0 \n 0 | 1 \n 0 | 0 \n 1 | 0 \n 0 | 1"},
            {"never false", "clk | q \n 1 | 0 \n 1 | 0 \n 1 | 0"},
            {"two scans at one instant after 100 days",
             "time clk | q \n 2400h 1 | 0 \n 2400h 0 | 1 \n 2400h 0 | 0 \n 2401h 0 | 0"},
        });
}
