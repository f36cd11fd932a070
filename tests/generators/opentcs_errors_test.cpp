// Broken plant models: a person is told where and what; a machine's garbage never gets past an InputError.
#include <gtest/gtest.h>

#include "core/base/error.hpp"
#include "core/base/random.hpp"
#include "damage.hpp"
#include "generators/formats/opentcs.hpp"
#include "independent_check.hpp"

namespace fleetproof::opentcs_errors_test {
namespace {

const std::string& crossdock() {
  static const std::string text = independent::file_text(independent::source_file("tests/layouts/crossdock.xml"));
  return text;
}

// Plain words of the file may stand in any encoding.
TEST(OpenTcsErrors, AnotherEncodingIsNamed) {
  const auto in = [](const std::string& encoding, const std::string& name) {
    const std::string head = encoding.empty() ? "" : "<?xml version=\"1.0\" encoding=\"" + encoding + "\"?>\n";
    return independent::refusal(
        [](const std::string& text) {
          std::vector<std::string> warnings;
          parse_opentcs(text, "m.xml", warnings);
        },
        head + "<model name=\"" + name + "\"/>");
  };
  const auto read = "m.xml:2: the model is empty: it has no <point>";
  EXPECT_EQ(in("GBK", "plant"), read);
  EXPECT_EQ(in("GBK", "\xbf\xec"), "m.xml:2: the file is in \"gbk\", which is not read here; save it as UTF-8");
  EXPECT_EQ(in("utf-8", "\xbf\xec"),
            "m.xml:2: the file is not UTF-8 here, as XML is unless it says otherwise; save it as UTF-8");
  EXPECT_EQ(in("", "\xbf\xec"),
            "m.xml:1: the file is not UTF-8 here, as XML is unless it says otherwise; save it as UTF-8");
  EXPECT_EQ(in("UTF-8", "\xc3\xa4"), read);
  EXPECT_EQ(in("ISO-8859-1", "\xe4"), read);
  EXPECT_EQ(in("windows-1252", "\xe4"), read);
}

TEST(OpenTcsErrors, EntitiesAreNotRead) {
  const auto import = [](const std::string& text) {
    std::vector<std::string> warnings;
    parse_opentcs(text, "m.xml", warnings);
  };
  EXPECT_EQ(independent::refusal(import, "<?xml version=\"1.0\"?>\n<!DOCTYPE m [<!ENTITY hall \"H\">]>\n<model/>"),
            "m.xml:2:14: declares an entity, which is not read; write its text where it is used");
}

void import(const std::string& text) {
  std::vector<std::string> warnings;
  parse_opentcs(text, "m.xml", warnings);
}

std::string refusal(const std::string& text) { return independent::refusal(import, text); }

struct Break {
  const char* name;
  const char* from;
  const char* to;
  const char* says;  // beginning of the message

  friend void PrintTo(const Break& b, std::ostream* out) { *out << b.name; }
};

const Break kBreaks[] = {
    {"missing_position", "positionX=\"3000\" ", "", "m.xml:4: <point> has no attribute \"positionX\"; add it"},
    {"second_attribute", "positionX=\"3000\" ", "positionX=\"3000\" positionX=\"9\" ",
     "m.xml:4: <point> has \"positionX\" twice, which is not well-formed XML; remove one"},
    {"missing_name", "<point name=\"South-1\" ", "<point ", "m.xml:4: <point> has no attribute \"name\"; add it"},
    {"empty_name", "<point name=\"South-1\" ", "<point name=\"\" ", "m.xml:4: name \"\": the name is empty"},
    {"nan", "positionX=\"3000\"", "positionX=\"NaN\"",
     "m.xml:4: positionX of <point> is \"NaN\"; expected a finite number"},
    {"infinite", "positionX=\"3000\"", "positionX=\"inf\"",
     "m.xml:4: positionX of <point> is \"inf\"; expected a finite number"},
    {"huge", "positionX=\"3000\"", "positionX=\"1e400\"",
     "m.xml:4: positionX of <point> is \"1e400\"; expected a finite number"},
    {"far", "positionX=\"3000\"", "positionX=\"1e15\"",
     "m.xml:4: <point> \"South-1\": coordinates lie within 100000 m"},
    {"garbage_number", "positionY=\"0\"", "positionY=\"12 apples\"",
     "m.xml:4: positionY of <point> is \"12 apples\"; expected a finite number"},
    {"empty_number", "positionY=\"0\"", "positionY=\"\"",
     "m.xml:4: positionY of <point> is \"\"; expected a finite number"},
    {"duplicate_point", "<point name=\"South-2\"", "<point name=\"South-1\"",
     "m.xml:8: a second <point> is named \"South-1\"; rename one"},
    {"unknown_point", "sourcePoint=\"South-1\"", "sourcePoint=\"Soth-1\"",
     "m.xml:137: sourcePoint of <path> is \"Soth-1\", but there is no such point; did you mean \"South-1\"?"},
    {"missing_point", "sourcePoint=\"South-1\" ", "", "m.xml:137: <path> has no attribute \"sourcePoint\"; add it"},
    {"loop", "destinationPoint=\"South-2\"", "destinationPoint=\"South-1\"",
     "m.xml:137: path \"South-1 to South-2\" leads from a point to itself"},
    {"duplicate_path", "<path name=\"South-2 to South-3\"", "<path name=\"South-1 to South-2\"",
     "m.xml:140: a second <path> is named"},
    {"control_points", "<controlPoint x=\"453\" y=\"0\"/>", "",
     "m.xml:150: path \"South-5 to East-1\" has 1 control points; BEZIER needs 2"},
    {"control_number", "<controlPoint x=\"453\"", "<controlPoint x=\"--\"",
     "m.xml:151: x of <controlPoint> is \"--\"; expected a finite number"},
    {"cusp", "<controlPoint x=\"453\" y=\"0\"/>\n            <controlPoint x=\"480\" y=\"-27\"/>",
     "<controlPoint x=\"420\" y=\"-600\"/><controlPoint x=\"420\" y=\"900\"/>",
     "m.xml:149: <path> \"South-5 to East-1\": it bends more sharply"},
    {"one_spot", "positionX=\"7500\" positionY=\"0\"", "positionX=\"3000\" positionY=\"0\"",
     "m.xml:137: <path> \"South-1 to South-2\": it has no length"},
    {"scale", "scaleX=\"50.0\"", "scaleX=\"0\"",
     "m.xml:330: scale 0 x 50 is not positive; give the millimetres of a unit of the drawing (openTCS: 50 x 50)"},
    {"scale_text", "scaleX=\"50.0\"", "scaleX=\"fifty\"",
     "m.xml:330: scaleX of <visualLayout> is \"fifty\"; expected a finite number"},
    {"location_type", "type=\"Floor storage\"", "type=\"Flor storage\"",
     "m.xml:316: type of location \"Floor lane 1\" is \"Flor storage\", but there is no such location type; did you "
     "mean "
     "\"Floor storage\"?"},
    {"far_location_type", "type=\"Floor storage\"", "type=\"Pier\"",
     "m.xml:316: type of location \"Floor lane 1\" is \"Pier\", but there is no such location type; add it or correct "
     "the name"},
    {"duplicate_location_type", "<locationType name=\"Battery charging\"", "<locationType name=\"Floor storage\"",
     "m.xml:294: a second <locationType> is named \"Floor storage\"; rename one"},
    {"duplicate_location", "<location name=\"Dock in 2\"", "<location name=\"Dock in 1\"",
     "m.xml:301: a second <location> is named \"Dock in 1\"; rename one"},
    {"locked_path", "maxReverseVelocity=\"0\" locked=\"false\"", "maxReverseVelocity=\"0\" locked=\"on\"",
     "m.xml:137: locked of <path> is \"on\"; expected true or false"},
    {"locked_location", "positionZ=\"0\" locked=\"false\" type", "positionZ=\"0\" locked=\"TRUE\" type",
     "m.xml:298: "
     "locked of <location> is \"TRUE\"; expected true or false"},
    {"second_model", "</model>", "</model>\n<model/>",
     "m.xml:335: \"model\" is a second element at the top of the file; XML has one there: remove it"},
    {"location_link", "<link point=\"Lane-1\"/>", "<link point=\"Lane-9\"/>",
     "m.xml:317: point of <link> is \"Lane-9\", but there is no such point"},
    {"other_root", "<model version", "<plan version", "m.xml:"},
};

class BrokenModel : public testing::TestWithParam<Break> {};

TEST_P(BrokenModel, IsExplained) {
  const auto& [name, from, to, says] = GetParam();
  auto text = crossdock();
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  const auto message = refusal(text.replace(at, std::string(from).size(), to));
  EXPECT_TRUE(message.starts_with(says)) << message << "\nexpected: " << says;
}

INSTANTIATE_TEST_SUITE_P(All, BrokenModel, testing::ValuesIn(kBreaks),
                         [](const auto& test) { return test.param.name; });

TEST(OpenTcsErrors, EmptyAndForeignTexts) {
  EXPECT_EQ(refusal("<model version=\"7.0.0\" name=\"void\"/>"), "m.xml:1: the model is empty: it has no <point>");
  EXPECT_EQ(refusal("<model version=\"7\"><point name=\"a\" positionX=\"0\" positionY=\"0\"/></model>"),
            "m.xml:1: the model has no <path> that may be driven; add or unlock some");
  EXPECT_EQ(refusal("<svg/>"), "m.xml: has no <model>; expected an openTCS plant model");
  EXPECT_NE(refusal("").find("not well-formed XML"), std::string::npos);
  EXPECT_NE(refusal("point,x,y\na,0,0\n").find("not well-formed XML"), std::string::npos);
  EXPECT_NE(refusal(std::string("\0\0\0\0", 4)).find("not well-formed XML"), std::string::npos);
  std::vector<std::string> warnings;
  EXPECT_THROW(read_opentcs("/nowhere/model.xml", warnings), InputError);
}

TEST(OpenTcsErrors, AFileCutInHalfIsRefusedAtItsEnd) {
  const auto message = refusal(crossdock().substr(0, crossdock().size() / 2));
  EXPECT_NE(message.find("not well-formed XML"), std::string::npos) << message;
}

TEST(OpenTcsErrors, EveryPrefixIsReadOrRefused) {
  const auto& text = crossdock();
  const auto whole = text.find("</model>");
  for (std::size_t i = 0; i < 200; ++i) EXPECT_NE(refusal(text.substr(0, whole * i / 200)), "accepted");
  EXPECT_EQ(refusal(text), "accepted");
}

TEST(OpenTcsErrors, RandomDamageIsReadOrRefused) {
  independent::bear_damage(import, crossdock(), 1500, "0123456789-.eEN\"'<>/=& \n\x80\xff");
}

TEST(OpenTcsErrors, RandomControlPointsAreReadOrRefused) {
  Draws draws(3);
  const std::string from = "<controlPoint x=\"453\" y=\"0\"/>\n            <controlPoint x=\"480\" y=\"-27\"/>";
  const auto at = crossdock().find(from);
  ASSERT_NE(at, std::string::npos);
  const auto number = [&](std::uint32_t range) {
    return std::to_string(static_cast<int>(draws.below(2 * range + 1)) - static_cast<int>(range));
  };
  int read = 0;
  for (int round = 0; round < 300; ++round) {
    const std::uint32_t range = round % 3 == 0 ? 3 : round % 3 == 1 ? 600 : 2'000'000;
    std::string to;
    for (int i = 0; i < 2; ++i) to += "<controlPoint x=\"" + number(range) + "\" y=\"" + number(range) + "\"/>";
    auto text = crossdock();
    if (refusal(text.replace(at, from.size(), to)) == "accepted") ++read;
  }
  EXPECT_GT(read, 100);
}

}  // namespace
}  // namespace fleetproof::opentcs_errors_test
