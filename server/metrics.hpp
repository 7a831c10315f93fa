#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "camera/pair_skew.hpp"
#include "server/publication.hpp"

namespace flogmap {

/// What Prometheus is told of the network side. Counters are cheap: an atomic addition.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  void count_response(int status, std::size_t bytes);
  void count_stream_message(std::size_t bytes);
  void count_received(std::size_t bytes);
  void count_refused_connection();
  void count_closed_stream(std::uint16_t code);
  void observe_query_s(double seconds);

  /// A value as it is now: gauges of the map and the mapping are set right before they are read.
  void set(const std::string& name, const std::string& help, double value);
  /// Likewise, one of several values that a label tells apart.
  void set(const std::string& name, const std::string& help, const std::string& label,
           const std::string& label_value, double value);
  void set_stage(const StageReport& stage);

  /// The histogram of a source's pairs, from its first one.
  void set_skew(const SkewHistogram& skew);

  /// Prometheus text format 0.0.4.
  [[nodiscard]] std::string text() const;

 private:
  struct Families;
  std::unique_ptr<Families> families_;
};

}  // namespace flogmap
