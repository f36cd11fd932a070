#pragma once

#include <cmath>

namespace fleetproof::oracle {

struct Point {
  double x = 0.0, y = 0.0;
};
inline Point operator+(Point p, Point q) { return {p.x + q.x, p.y + q.y}; }
inline Point operator-(Point p, Point q) { return {p.x - q.x, p.y - q.y}; }
inline Point operator*(double s, Point p) { return {s * p.x, s * p.y}; }
inline double dot(Point p, Point q) { return p.x * q.x + p.y * q.y; }
inline double cross(Point p, Point q) { return p.x * q.y - p.y * q.x; }
inline double length(Point p) { return std::sqrt(dot(p, p)); }
inline Point left_of(Point p) { return {-p.y, p.x}; }
inline Point direction(double angle_rad) { return {std::cos(angle_rad), std::sin(angle_rad)}; }

}  // namespace fleetproof::oracle
