#include "runtime/study/junit.hpp"

#include <catch2/catch.hpp>

using namespace lineshaft;

TEST_CASE("a suite is counted, and passed cases are empty elements") {
    CHECK(junit_xml({{.name = "a.yaml", .wall_seconds = 0.25},
                     {.name = "b.yaml",
                      .wall_seconds = 1.5,
                      .failures = {"x is 1", "y is 2"},
                      .repeat = "lineshaft run b.yaml"},
                     {.name = "c.yaml", .failures = {"no such file"}, .error = true},
                     {.name = "d.yaml", .skipped = "slow"}}) ==
          "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
          "<testsuite name=\"lineshaft\" tests=\"4\" failures=\"1\" errors=\"1\" skipped=\"1\" "
          "time=\"1.750\">\n"
          "  <testcase classname=\"a.yaml\" file=\"a.yaml\" name=\"a.yaml\" time=\"0.250\"/>\n"
          "  <testcase classname=\"b.yaml\" file=\"b.yaml\" name=\"b.yaml\" time=\"1.500\">\n"
          "    <failure message=\"x is 1\">x is 1\nrepeat it by: lineshaft run b.yaml</failure>\n"
          "    <failure message=\"y is 2\">y is 2\nrepeat it by: lineshaft run b.yaml</failure>\n"
          "  </testcase>\n"
          "  <testcase classname=\"c.yaml\" file=\"c.yaml\" name=\"c.yaml\" time=\"0.000\">\n"
          "    <error message=\"no such file\">no such file</error>\n"
          "  </testcase>\n"
          "  <testcase classname=\"d.yaml\" file=\"d.yaml\" name=\"d.yaml\" time=\"0.000\">\n"
          "    <skipped message=\"slow\"/>\n"
          "  </testcase>\n"
          "</testsuite>\n");
}

TEST_CASE("a suite without cases is still a suite") {
    CHECK_THAT(junit_xml({}),
               Catch::Contains("tests=\"0\" failures=\"0\" errors=\"0\" skipped=\"0\""));
}

TEST_CASE("what XML reserves is escaped, what it forbids is replaced") {
    const std::string xml =
        junit_xml({{.name = "<a> & \"b\"", .failures = {"first <line>\nsecond\tline \x01\x1b"}}});
    CHECK_THAT(xml, Catch::Contains("name=\"&lt;a&gt; &amp; &quot;b&quot;\""));
    CHECK_THAT(xml, Catch::Contains("message=\"first &lt;line&gt;\">"));
    CHECK_THAT(xml, Catch::Contains("first &lt;line&gt;\nsecond\tline ?\?</failure>"));
}
