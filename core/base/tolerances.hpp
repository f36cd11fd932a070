#pragma once

#include <limits>

namespace fleetproof {

// Every tolerance of the model, the laws and the readers of layouts: how small a difference is taken as none. Each one
// says why it has its value and what goes wrong if it is larger or smaller. The values are part of every trace digest
// or verdict: a change is a change of results.
//
// Scale: a double holds a coordinate of 1 km to 1e-13 m, the distance of two rectangles is exact to 1e-12 m, the first
// instant below a level to 1 microsecond (2e-6 m at 2 m/s), on straight lines to 2 ns.
//
// Not here: sizes that a user may know as a rule (kNearMiss_m, kHazardousSpeed_um_s), steps of a numerical method that
// changes no result, and the tolerances of core/agents, which share nothing with the judge on purpose.

// ---- contact and clearance

// Two bodies touch when less than this is between them; the world then stops them.
// Larger: bodies stop that pass each other with a clearance that a person could measure. Smaller: rounding decides
// whether a touch along a common edge is seen.
inline constexpr double kTouch_m = 1e-6;

// A law calls a violation a contact if the clearance is below kTouch_m at the end of a piece, or below this in between.
// The world looks for kTouch_m and may pass over a dip of kDip_m. So each contact that a law files is one that the
// world has found, and each stop at a touch is the end of a piece. Larger: the law files contacts at which the world
// stops nobody. Smaller: contacts of bodies that graze each other are not filed if nothing stops them.
inline constexpr double kContact_m = kTouch_m - 2e-9;

// What is built at exactly a distance keeps it: a clearance is too small only if this much is missing. It makes the one
// threshold of all laws (violation_threshold_m), and judges starts and the places at which the operator sets AGVs down.
// Larger: violations by less than this are not found. Smaller: lanes built at exactly the safety distance are accused
// because of rounding.
inline constexpr double kBuiltToTheLimit_m = 1e-6;

// A dip below a level that is no deeper than this may be passed over.
// Larger: real violations are passed over. Zero: bodies that run along exactly at the level are followed nanosecond by
// nanosecond, and a run never ends.
inline constexpr double kDip_m = 1e-9;

// The smallest clearance over an interval is found to within this.
// Larger: the figure in the outcome is wrong in its last printed digit, a micrometre. Smaller: more evaluations.
inline constexpr double kSmallestClearance_m = 1e-7;

// Instants have the same least clearance if it differs by less: a flat minimum.
// Larger: instants count that are not the closest. At kDip_m or below: the walk does not find the ends of the minimum.
inline constexpr double kSameClearance_m = 2e-9;

// The clearance no longer changes if its rate is smaller: the bottom of a minimum.
// Larger: the closest instant is dated away from the minimum, by rate over curvature: 1 ns at 1 m/s2. Smaller: rounding
// decides where a flat minimum begins.
inline constexpr double kStationary_mps = 1e-9;

// The least clearance that is one: a level for "the bodies overlap".
// Larger: the first instant of an overlap is dated before the touch. Zero: no clearance is ever below the level.
inline constexpr double kOverlap_m = std::numeric_limits<double>::denorm_min();

// Corners are equally near if their gaps differ by less; the one that comes nearer then decides.
// Larger: a corner decides that is not the nearest, and the search starts in a poor place. Smaller: rounding chooses
// between two corners of an edge that runs parallel to the other body. The result stays the same, the cost does not.
inline constexpr double kEquallyNear_m = 1e-9;

// A direction is that of a body's side if the sine of the angle between them is smaller.
// Larger: the gap to a corner is bounded as if it were a gap to a side, and bounds get worse. Smaller: rounding turns
// sides into corners. The result stays the same, the cost does not.
inline constexpr double kAlongSide = 1e-9;

// Offsets shorter than this have no direction that is more than rounding.
// Larger: the direction of the closest points is taken from an axis although the points show it better. Smaller: a
// random direction.
inline constexpr double kNoDirection_m = 1e-11;

// The second opinion of FCL and the law measure the same clearance if they differ by less, and may disagree about an
// overlap of less than the second value.
// Larger: a wrong kernel is not noticed. Smaller: the rounding of FCL's iteration is filed as an engine error.
inline constexpr double kOpinionsAgree_m = 1e-4;
inline constexpr double kSurelyApart_m = 1e-6;

// ---- lines, curves, directions

// Points nearer than this are one point, in the construction of arcs.
// Larger: short arcs vanish and a curve gets a kink. Smaller: a direction is computed from rounding.
inline constexpr double kSamePoint_m = 1e-12;

// An arc that turns by less than twice this is straight: its radius would exceed a million kilometres.
// Larger: ends of arcs move by more than rounding. Smaller: the radius overflows.
inline constexpr double kStraightArc_rad = 1e-12;

// Control points lie on the line of a segment if they are aside by less than this share of its length.
// Larger: flat bends become straight lines. Smaller: straight segments become chains of arcs of huge radius.
inline constexpr double kOnTheLine = 1e-11;

// The place on a Bezier curve at an arc length is right to this, and so is the length of the curve.
// Larger: the motion of a body is not the one that the bounds of the walk assume; at kDip_m, violations are passed
// over. Smaller: more parts, so more changes of the law of motion.
inline constexpr double kAlongCurve_m = 1e-10;

// Control software is given a Bezier curve as arcs that stay within this distance and heading of it. The judge uses the
// curve itself.
// Larger: sound software cannot know where its AGV will be to the margin that it keeps. Smaller: more arcs in each map.
inline constexpr double kBezierByArcs_m = 1e-4;
inline constexpr double kHeadingByArcs_rad = 2e-3;

// What is built to the safety distance on curves: for each body that drives a curve, a clearance must be this much
// smaller before it is a violation.
// Larger: violations by less than this are not found. Smaller: lanes that bend side by side at exactly the safety
// distance are accused, because the line beside a Bezier curve is no Bezier curve: layouts come near it.
inline constexpr double kBuiltOnCurves_m = 1e-5;

// Arcs and Bezier curves join smoothly if their headings differ by less.
// Larger: the heading of an AGV jumps in mid-segment. Smaller: rounding refuses layouts that are smooth.
inline constexpr double kKink_rad = 1e-9;

// Headings are opposite if the sine of the angle between them is smaller; the turn between them then goes left.
// Larger: turns of nearly half a circle go the long way. Smaller: the last bit decides between left and right.
inline constexpr double kOpposite = 1e-15;

// The headings of two segments that meet are the same if they differ by less: the AGV drives on without a turn.
// Larger: the heading of an AGV jumps at a station. Smaller: the rounding of a curve's end makes an AGV stop and turn.
// The engine and the timetable of the generators must agree on it.
inline constexpr double kAligned_rad = 1e-7;

// A vector is a unit vector if the square of its length differs from 1 by less; read from a file, it is kept to the bit
// below the second value and normalized otherwise; a vector shorter than the third has no direction.
// Larger: bodies change their size with their heading. Smaller: headings that were written to a file are refused, or
// change when they are read again.
inline constexpr double kUnitVector = 1e-9;
inline constexpr double kUnitVectorToTheLastDigits = 1e-12;
inline constexpr double kShortestHeading = 1e-9;

// The box around a curved drive may reach this much farther than the body.
// Larger: more pairs of bodies are looked at that never come near. Smaller: more poses for each box.
inline constexpr double kBoxSlack_m = 0.02;

// ---- motion

// An AGV can stop within a way that is short of its braking distance by no more than this, in absolute terms and as a
// share of the way.
// Larger: AGVs brake harder than they can. Smaller: an AGV whose way is exactly its braking distance rolls through.
inline constexpr double kBrakingRounding_m = 1e-9;
inline constexpr double kBrakingRounding = 1e-12;

// A square of a speed below this is standing, plus this share of the square of the speed before.
// Larger: slow AGVs jump to a stop. Smaller: rounding leaves an AGV creeping where it should stand.
inline constexpr double kStands_m2ps2 = 1e-10;
inline constexpr double kStands = 1e-12;

// Rounding may leave a planned end speed this much out of reach within its way.
// Larger: speeds jump at the seam of two legs. Smaller: a plan that is right is filed as an engine error.
inline constexpr double kReachable_mps = 1e-4;

// ---- radio

// An AGV leaves a radio cell this far beyond the border.
// Larger: handovers come late. Zero: an AGV that stands on a border, or drives along it, changes over for ever.
inline constexpr double kBeyondBorder_m = 1e-6;

// An excursion of a curved drive over a border that is shallower than this may be missed.
// Larger: handovers are missed. Smaller: more steps along each curve.
inline constexpr double kUnseenExcursion_m = 1e-4;

// ---- places and layouts

// An AGV stands at a station if its reference point is no farther from it.
// Larger: an AGV that stopped short is taken as arrived. Smaller: a position error of the layout counts as absence.
inline constexpr double kAtStation_m = 0.05;

// Vectors of a Bezier's control polygon that are shorter than this have no direction.
// Larger: kinks at short handles are not found. Smaller: rounding is reported as a kink.
inline constexpr double kNoHandle_m = 1e-9;

// Points of a NURBS curve that are nearer to each other, or to a line, are one point, or lie on the line.
// Larger: the curve loses its shape. Smaller: rounding in the file makes segments of no length.
inline constexpr double kNurbsPoint_m = 1e-6;

// Cubic pieces stand for a NURBS curve if they are this near to it, in place and heading.
// Larger: bodies are judged where they are not, a corner at 3 m by three times the second value. Smaller: more pieces.
inline constexpr double kNurbsByCubics_m = 1e-6;
inline constexpr double kNurbsByCubics_rad = 2e-6;

// The arc of an imported polyline leaves the legs this far from the corner. For a right angle, that is its radius.
// Larger: AGVs pass farther inside a corner than the plant draws it. Smaller: they turn nearly on the spot.
inline constexpr double kCornerRounding_m = 0.5;

// Two segments are the two directions of one track if their control points differ by less.
// Larger: neighbouring tracks become one. Smaller: layouts that were rounded to a millimetre get every track twice.
inline constexpr double kSameTrack_m = 1e-3;

// The trajectory of an edge in a LIF file may end this far from its node without a word.
// Larger: a wrong node is drawn to without a warning. Smaller: warnings about rounding in the file.
inline constexpr double kOnTheNode_m = 1e-3;

// Joints of imported curves with a smaller kink are smoothed, with a warning; larger ones are refused.
// Larger: a corner that was meant is rounded. Smaller: layouts drawn by hand are refused.
inline constexpr double kSmoothedKink_rad = 0.2;

}  // namespace fleetproof
