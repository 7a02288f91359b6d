// JSON of files that nobody vouches for: bounded in size, and no key twice in an object, where readers differ on which
// one counts.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/result.h"

namespace froth {

// A parsed file takes about seven times its size of memory.
inline constexpr uint64_t kMostJsonBytes = uint64_t{32} << 20;

// Watches a parser for keys that come twice.
template <class Json>
class KeyWatch {
 public:
  bool operator()(int, typename Json::parse_event_t event, const Json& parsed) {
    using Event = typename Json::parse_event_t;
    if (event == Event::object_start) open_.emplace_back();
    if (event == Event::object_end) open_.pop_back();
    if (event != Event::key || !repeated_.empty()) return true;
    const std::string& key = parsed.template get_ref<const std::string&>();
    if (!open_.back().insert(key).second) repeated_ = '\'' + key + '\'';
    return true;
  }

  const std::string& repeated() const { return repeated_; }  // in quotes; empty: none

 private:
  std::vector<std::set<std::string>> open_;  // keys of the objects around the place of the parser
  std::string repeated_;
};

// `file` names the bytes in messages, `remedy` says what they should be. Fails with kBadInput.
template <class Json = nlohmann::json>
Result<Json> parseJson(std::span<const uint8_t> bytes, const std::string& file, const char* remedy) {
  if (bytes.size() > kMostJsonBytes) {
    return makeError(ErrorKind::kBadInput, "%s: %zu bytes of JSON, more than %llu; split it", file.c_str(),
                     bytes.size(), static_cast<unsigned long long>(kMostJsonBytes));
  }
  KeyWatch<Json> keys;
  Json json;
  try {
    json = Json::parse(bytes.begin(), bytes.end(), std::ref(keys));
  } catch (const typename Json::parse_error& fault) {
    return makeError(ErrorKind::kBadInput, "%s: byte %zu: not JSON (%s); %s", file.c_str(), size_t{fault.byte},
                     fault.what(), remedy);
  } catch (const typename Json::exception& fault) {  // a number beyond the range of double
    return makeError(ErrorKind::kBadInput, "%s: %s; give numbers that a double can hold", file.c_str(), fault.what());
  }
  if (keys.repeated().empty()) return json;
  return makeError(ErrorKind::kBadInput, "%s: key %s stands twice in one object; remove one", file.c_str(),
                   keys.repeated().c_str());
}

}  // namespace froth
