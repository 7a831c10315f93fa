#pragma once

#include <cstdint>
#include <string>

#include "server/options.hpp"

namespace flogmap {

/// Reads the tokens, checks addresses and limits, finds the built page. Throws UsageError in one line.
void settle_serving(Options& options);

/// Says what is done and where to look at it; warns if everybody may, or if there is no page. `page`: its
/// path.
void announce(const Options& options, std::uint16_t port, const std::string& what,
              const std::string& page = {});

}  // namespace flogmap
