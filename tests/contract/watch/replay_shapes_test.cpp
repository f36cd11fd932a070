// What the replay page says of the shapes of two bodies that came too close. Scenes are built so that one thing
// decides, by a margin that pencil and paper give.
#include <gmock/gmock.h>

#include <pugixml.hpp>

#include "tests/support/program.hpp"

namespace fleetproof::replay_shapes_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::string kMove = R"({"at_s": 1, "action": "move", "segment": "ab"})";
const std::string kPick = R"({"at_s": 1, "action": "pick"})";

struct Scene {
  std::string script = kMove;
  std::string b = "[9, 0]", bend = {};  // the end of the way of A, which begins at [0, 0]
  std::string other = {};               // the place of B
  std::string vehicle = {};             // properties of the vehicle of A
};

class ReplayShapes : public test::ProgramTest {
 protected:
  // The sentences about shapes. A and B head along x; B is 1.6 m by 1 m.
  std::vector<std::string> said_of(const Scene& scene) const {
    write("s.json", R"({"version": 1, "name": "scene", "horizon_s": 30, "vehicle_types": [{"name": "mine")" +
                        scene.vehicle +
                        R"(}, {"name": "other"}], "agvs": [
          {"name": "A", "type": "mine", "start": "a", "heading": [1, 0], "script": [)" +
                        scene.script + R"(], "transports": [{"from": "a", "to": "b", "release_s": 0}]},
          {"name": "B", "type": "other", "start": "p", "heading": [1, 0]}],
          "layout": {"name": "scene", "floor_low_m": [-9, -9], "floor_high_m": [20, 20], "stations": [
          {"name": "a", "position_m": [0, 0]}, {"name": "b", "position_m": )" +
                        scene.b + R"(}, {"name": "p", "position_m": )" + scene.other + R"(}],
          "segments": [{"name": "ab", "from": "a", "to": "b")" +
                        scene.bend + R"(}, {"name": "bp", "from": "b", "to": "p"}]}})");
    const auto done = run("simulate s.json --html p.html");
    EXPECT_EQ(done.exit_code, 1) << done.out << done.err;
    pugi::xml_document document;
    const std::string text = read(path("p.html"));
    EXPECT_TRUE(document.load_buffer(text.data(), text.size(), pugi::parse_full));
    std::vector<std::string> said;
    for (const auto& found : document.select_nodes("//div[starts-with(@class, 'story')]/p")) {
      const std::string sentence = found.node().text().get();
      if (sentence.starts_with("As they moved, it took") || sentence.starts_with("They keep") ||
          sentence.find("share no station") != sentence.npos)
        said.push_back(sentence);
    }
    return said;
  }
};

constexpr const char* kApart =
    "A was at a, B at p: these share no station and no segment. Only their shapes on the floor come too close.";

// A turns to 90 degrees. The near corner of B is at (0.625, 0.625): 0.125 m beside A before the turn and after it.
TEST_F(ReplayShapes, ASweepThatIsNeeded) {
  EXPECT_THAT(
      said_of({.b = "[0, 9]", .other = "[1.425, 1.125]"}),
      ElementsAre(
          "As they moved, it took the sweep of the turn on the spot of A: with the heading before the turn, and "
          "with that after it, A keeps 0.12 m from B. As it turns, its corners reach 0.94 m from "
          "its axis.",
          kApart));
}

// At (0.665, 0.665) it is 0.94 m from the axis: 0.14 m from a disc of 0.8 m.
TEST_F(ReplayShapes, CornersThatAreNeeded) {
  EXPECT_THAT(
      said_of({.b = "[0, 9]", .other = "[1.465, 1.165]"}),
      ElementsAre(
          "As they moved, it took the sweep of the turn on the spot of A: with the heading before the turn, and "
          "with that after it, A keeps 0.16 m from B. As it turns, its corners reach 0.94 m from "
          "its axis.",
          "As they moved, it took the corners of A in its turn on the spot: a disc about its axis that reaches to "
          "the ends of A, 0.80 m, keeps 0.14 m from B. Its corners are 0.94 m from the axis.",
          kApart));
}

// The near corner of B, (3.11, 0.89), is 1.57 m from the straight line, and so 1.07 m from A on it.
TEST_F(ReplayShapes, ABendThatIsNeeded) {
  EXPECT_THAT(
      said_of({.b = "[4, 4]", .bend = R"(, "control_points_m": [[2.2, 0], [4, 1.8]])", .other = "[3.91, 0.39]"}),
      ElementsAre("As they moved, it took the bend of the lane of A: on the straight line between the ends of that "
                  "lane, A keeps "
                  "1.06 m from B. The lane goes up to 1.16 m aside of the line.",
                  "A was on the lane between a and b, B at p: these share no station and no segment. Only their shapes "
                  "on the floor come too close."));
}

TEST_F(ReplayShapes, ALoadThatIsNeeded) {
  EXPECT_THAT(
      said_of({.script = kPick, .other = "[1.905, 0]", .vehicle = R"(, "loaded": {"extra_length_m": 0.6})"}),
      ElementsAre(
          "As they moved, it took the load of A: without it, A keeps 0.30 m from B. The load makes it 0.60 m longer "
          "and 0.00 m wider.",
          kApart));
}

// A passes beside B, 0.055 m apart; 0.3 m more if it were as narrow.
TEST_F(ReplayShapes, ASizeThatIsNeeded) {
  EXPECT_THAT(
      said_of({.other = "[5, 1.3552]", .vehicle = R"(, "width_m": 1.6)"}),
      ElementsAre(
          "As they moved, it took the size of A: with the size of B, it would keep 0.35 m from it. A is 1.60 m by "
          "1.60 m, B is 1.60 m by 1.00 m.",
          "A was on the lane between a and b, B at p: these share no station and no segment. Only their "
          "shapes on the floor come too close.",
          "They keep more than half of the safety distance: 0.055 m of 0.10 m."));
}

// 0.04 m is less than half of it.
TEST_F(ReplayShapes, LessThanHalfOfTheSafetyDistanceIsNotPraised) {
  EXPECT_THAT(said_of({.other = "[5, 1.3402]", .vehicle = R"(, "width_m": 1.6)"}), testing::SizeIs(2));
}

// Nothing in the shapes decides: A drives over B, who stands where A goes, whatever their sizes.
TEST_F(ReplayShapes, NothingIsSaidIfNothingOfThemDecides) {
  EXPECT_THAT(
      said_of({.other = "[9.5, 0]", .vehicle = R"(, "width_m": 1.6, "loaded": {"extra_length_m": 0.6})"}),
      ElementsAre("A was on the lane between a and b, B at p: these share no station and no segment. Only their "
                  "shapes on the floor come too close."));
  // At 90 degrees, A would stand in B: the sweep alone decides nothing.
  EXPECT_THAT(said_of({.b = "[0, 9]", .other = "[0, 1.25]"}), ElementsAre(kApart));
  EXPECT_THAT(said_of({.b = "[5, 0]", .other = "[5.5, 0]", .vehicle = R"(, "width_m": 1.6)"}), testing::SizeIs(1));
}

// An AGV on the way between two stations meets one that stands at its end.
TEST_F(ReplayShapes, AStationThatIsSharedIsNotAMatterOfShapes) {
  write("s.json", R"({"version": 1, "name": "scene", "horizon_s": 30, "agvs": [
      {"name": "A", "start": "a", "heading": [1, 0], "script": [)" +
                      kMove + R"(]}, {"name": "B", "start": "b", "heading": [1, 0]}],
      "layout": {"name": "scene", "floor_low_m": [-9, -9], "floor_high_m": [20, 20], "stations": [
      {"name": "a", "position_m": [0, 0]}, {"name": "b", "position_m": [9, 0]}],
      "segments": [{"name": "ab", "from": "a", "to": "b"}]}})");
  EXPECT_EQ(run("simulate s.json --html p.html").exit_code, 1);
  EXPECT_EQ(read(path("p.html")).find("share no station"), std::string::npos);
  EXPECT_NE(read(path("p.html")).find("A was driving from a to b"), std::string::npos);
}

}  // namespace
}  // namespace fleetproof::replay_shapes_test
