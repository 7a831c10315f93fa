#include "server/metrics.hpp"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <array>
#include <map>
#include <vector>

namespace flogmap {

namespace ps = prometheus;

struct Metrics::Families {
  ps::Registry registry;
  ps::Family<ps::Counter>& responses = ps::BuildCounter()
                                           .Name("flogmap_http_responses_total")
                                           .Help("HTTP responses by status class")
                                           .Register(registry);
  // By hundreds of the status, so that counting one is an array access.
  std::array<ps::Counter*, 6> by_class{};
  ps::Family<ps::Counter>& bytes = ps::BuildCounter()
                                       .Name("flogmap_network_bytes_total")
                                       .Help("Bytes of bodies and stream messages, by way")
                                       .Register(registry);
  ps::Counter& http_sent = bytes.Add({{"way", "http_sent"}});
  ps::Counter& stream_sent = bytes.Add({{"way", "stream_sent"}});
  ps::Counter& stream_received = bytes.Add({{"way", "stream_received"}});
  ps::Counter& stream_messages = ps::BuildCounter()
                                     .Name("flogmap_stream_messages_total")
                                     .Help("Messages sent to viewers")
                                     .Register(registry)
                                     .Add({});
  ps::Counter& refused = ps::BuildCounter()
                             .Name("flogmap_connections_refused_total")
                             .Help("Connections turned away by a limit")
                             .Register(registry)
                             .Add({});
  ps::Family<ps::Counter>& closed = ps::BuildCounter()
                                        .Name("flogmap_streams_closed_total")
                                        .Help("Streams closed by the server, by close code")
                                        .Register(registry);
  ps::Histogram& query_s = ps::BuildHistogram()
                               .Name("flogmap_query_seconds")
                               .Help("Time of routes, pictures and exports on the query thread")
                               .Register(registry)
                               .Add({}, ps::Histogram::BucketBoundaries{0.001, 0.01, 0.1, 1, 10});
  ps::Family<ps::Histogram>& stages = ps::BuildHistogram()
                                          .Name("flogmap_stage_seconds")
                                          .Help("Time of the mapping's stages per frame")
                                          .Register(registry);
  std::map<std::string, StageReport> seen_stages;  // what the histograms hold already

  ps::Histogram* skew_s = nullptr;
  SkewHistogram known_skew;  // what of it is in skew_s

  Families() {
    for (int hundreds = 1; hundreds < 6; ++hundreds) {
      by_class[hundreds] = &responses.Add({{"status", std::to_string(hundreds) + "xx"}});
    }
  }
};

Metrics::Metrics() : families_(std::make_unique<Families>()) {}
Metrics::~Metrics() = default;

void Metrics::count_response(int status, std::size_t bytes) {
  families_->by_class[status / 100]->Increment();
  families_->http_sent.Increment(static_cast<double>(bytes));
}

void Metrics::count_stream_message(std::size_t bytes) {
  families_->stream_messages.Increment();
  families_->stream_sent.Increment(static_cast<double>(bytes));
}

void Metrics::count_received(std::size_t bytes) {
  families_->stream_received.Increment(static_cast<double>(bytes));
}

void Metrics::count_refused_connection() { families_->refused.Increment(); }

void Metrics::count_closed_stream(std::uint16_t code) {
  families_->closed.Add({{"code", std::to_string(code)}}).Increment();
}

void Metrics::observe_query_s(double seconds) { families_->query_s.Observe(seconds); }

void Metrics::set(const std::string& name, const std::string& help, double value) {
  ps::BuildGauge().Name(name).Help(help).Register(families_->registry).Add({}).Set(value);
}

void Metrics::set(const std::string& name, const std::string& help, const std::string& label,
                  const std::string& label_value, double value) {
  ps::BuildGauge().Name(name).Help(help).Register(families_->registry).Add({{label, label_value}}).Set(value);
}

/// The pipeline has counted already; the histogram is told what is new.
void Metrics::set_stage(const StageReport& stage) {
  ps::Histogram::BucketBoundaries bounds_s;
  for (const double ms : kTimeClassesMs) bounds_s.push_back(ms / 1000);
  ps::Histogram& histogram = families_->stages.Add({{"stage", stage.stage}}, bounds_s);
  StageReport& seen = families_->seen_stages[stage.stage];
  std::vector<double> added;
  for (std::size_t i = 0; i < stage.counts.size(); ++i) {
    added.push_back(static_cast<double>(stage.counts[i] - seen.counts[i]));
  }
  histogram.ObserveMultiple(added, (stage.total_ms - seen.total_ms) / 1000);
  seen = stage;
}

void Metrics::set_skew(const SkewHistogram& skew) {
  constexpr double kMsPerS = 1000;
  if (families_->skew_s == nullptr) {  // only where cameras are timed one by one
    ps::Histogram::BucketBoundaries bounds(SkewHistogram::kUpperMs.begin(), SkewHistogram::kUpperMs.end());
    for (double& bound : bounds) bound /= kMsPerS;
    families_->skew_s = &ps::BuildHistogram()
                             .Name("flogmap_pair_skew_seconds")
                             .Help("Time between the two pictures of a pair, dropped pairs included")
                             .Register(families_->registry)
                             .Add({}, bounds);
  }
  SkewHistogram& known = families_->known_skew;
  if (skew.total() < known.total()) known = {};
  std::vector<double> more(skew.counts.size());
  for (std::size_t i = 0; i < more.size(); ++i)
    more[i] = static_cast<double>(skew.counts[i] - known.counts[i]);
  families_->skew_s->ObserveMultiple(more, (skew.sum_ms - known.sum_ms) / kMsPerS);
  known = skew;
}

std::string Metrics::text() const { return ps::TextSerializer().Serialize(families_->registry.Collect()); }

}  // namespace flogmap
