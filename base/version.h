// Which Froth this is.
#pragma once

namespace froth {

// "0.1.0 (19a2b5e)": the release, and the commit it was built from; "-dirty" behind it: with changes that are not in
// it. An archive without a repository tells its release alone.
extern const char* const kVersion;

}  // namespace froth
