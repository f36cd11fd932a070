#include "core/bridges/vda5050/vehicle_errors.hpp"

#include <algorithm>

namespace fleetproof::bridges::vda5050 {
namespace {

// Values come from a message, and may be as long as one. They are cut between two characters of UTF-8.
std::string shortened(const std::string& value) {
  constexpr std::size_t kMostOfAReference = 128;
  if (value.size() <= kMostOfAReference) return value;
  std::size_t end = kMostOfAReference;
  while ((static_cast<unsigned char>(value[end]) & 0xc0) == 0x80) --end;
  return value.substr(0, end);
}

bool same(const Error& a, const Error& b) {
  return a.error_type == b.error_type && a.error_references == b.error_references &&
         a.error_description == b.error_description && a.error_level == b.error_level;
}

}  // namespace

bool VehicleErrors::raise(const Error& error) {
  const auto known = std::ranges::find(of_body_, error.error_type, &Error::error_type);
  if (known == of_body_.end()) {
    of_body_.push_back(error);
    return true;
  }
  const bool is_news = !same(*known, error);
  *known = error;
  return is_news;
}

bool VehicleErrors::clear(std::string_view error_type) {
  return std::erase_if(of_body_, [&](const Error& error) { return error.error_type == error_type; }) > 0;
}

void VehicleErrors::reject(const Refusal& refusal, std::vector<Reference> references) {
  references.insert(references.end(), refusal.references.begin(), refusal.references.end());
  for (Reference& reference : references) reference.reference_value = shortened(reference.reference_value);
  const Error error{refusal.error_type, std::move(references), refusal.why, {}, ErrorLevel::Warning};
  if (std::ranges::any_of(rejections_, [&](const Error& known) { return same(known, error); })) return;
  rejections_.push_back(error);
  if (rejections_.size() > most_) rejections_.erase(rejections_.begin());
}

std::vector<Error> VehicleErrors::active() const {
  std::vector<Error> errors = of_body_;
  errors.insert(errors.end(), rejections_.begin(), rejections_.end());
  return errors;
}

}  // namespace fleetproof::bridges::vda5050
