// Stands for http_reader.cpp in a build without libcurl.
#include "host/http_reader.h"

namespace froth {

struct HttpReader::State {};

Result<std::unique_ptr<HttpReader>> HttpReader::open(const std::string& url, FrothContext*, const HttpOptions&) {
  return makeError(
      ErrorKind::kUnsupported,
      "%s: this program was built without libcurl; install libcurl4-openssl-dev and build again, or give a file",
      url.c_str());
}

HttpReader::~HttpReader() = default;
FrothReader HttpReader::reader() { return {}; }
std::string HttpReader::lastFault() const { return {}; }
uint64_t HttpReader::retries() const { return 0; }

}  // namespace froth
