#include "mapping/odometry/consistency.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "mapping/triangulate.hpp"

namespace flogmap {
namespace {

/// (dL L / k)^2 of FLOG.md section 9, u = P1 - P2.
double scaled_length_variance(double t, const Eigen::Vector3d& u, const Eigen::Vector3d& P1,
                              const Eigen::Vector3d& P2) {
  const double along_1 = u.dot(P1), along_2 = u.dot(P2);
  const double A1 = (u.x() * t - along_1) * (u.x() * t - along_1), B1 = along_1 * along_1;
  const double A2 = (u.x() * t - along_2) * (u.x() * t - along_2), B2 = along_2 * along_2;
  const double c = t * t * u.y() * u.y() / 2;
  return P1.z() * P1.z() * (A1 + B1 + c) + P2.z() * P2.z() * (A2 + B2 + c);
}

/// A correspondence with what is needed of it again and again.
struct Prepared {
  PointPair pair;
  double variance = 0;  // of both points together, in all directions, metres^2
};

class Agreement {
 public:
  Agreement(const StereoCamera& camera, const ConsistencyOptions& options)
      : t_(camera.baseline_m),
        k_squared_(std::pow(options.image_sigma_px / (camera.focal_px * camera.baseline_m), 2)),
        num_sigmas_squared_(options.num_sigmas * options.num_sigmas),
        cos_max_turn_(std::cos(options.max_turn_rad.value_or(0))),
        options_(options) {}

  /// True if a rigid motion can take both points from the key frame to the current one.
  bool operator()(const Prepared& a, const Prepared& b) const {
    const Eigen::Vector3d u = a.pair.in_key - b.pair.in_key;
    const Eigen::Vector3d v = a.pair.in_current - b.pair.in_current;
    const double L2_u = u.squaredNorm(), L2_v = v.squaredNorm();
    if (L2_u < 1e-12 || L2_v < 1e-12) return false;  // the same point twice says nothing
    const double gap = std::sqrt(L2_u) - std::sqrt(L2_v);
    const double bound = num_sigmas_squared_ * (a.variance + b.variance);
    if (gap * gap > bound) return false;  // dL^2 is never larger than the points' whole variance
    const double variance =
        k_squared_ * (scaled_length_variance(t_, u, a.pair.in_key, b.pair.in_key) / L2_u +
                      scaled_length_variance(t_, v, a.pair.in_current, b.pair.in_current) / L2_v);
    return gap * gap <= num_sigmas_squared_ * variance && turned_little(u.dot(v), L2_u, L2_v, bound);
  }

 private:
  /// The direction of u turned less than theta_max, give or take what the points' errors can turn it.
  bool turned_little(double dot, double L2_u, double L2_v, double bound) const {
    if (!options_.max_turn_rad) return true;
    const double length_product = std::sqrt(L2_u * L2_v);
    if (dot >= cos_max_turn_ * length_product) return true;
    const double slack = std::sqrt(bound / std::min(L2_u, L2_v));
    const double limit = *options_.max_turn_rad + slack;
    return limit >= EIGEN_PI || dot >= std::cos(limit) * length_product;
  }

  double t_;
  double k_squared_;
  double num_sigmas_squared_;
  double cos_max_turn_;
  ConsistencyOptions options_;
};

/// A set of indices as bits.
using Bits = std::vector<std::uint64_t>;

bool has(const Bits& set, int i) { return (set[i / 64] >> (i % 64)) & 1U; }
void put(Bits& set, int i) { set[i / 64] |= std::uint64_t{1} << (i % 64); }

int count_common(const Bits& a, const Bits& b) {
  int count = 0;
  for (std::size_t w = 0; w < a.size(); ++w) count += std::popcount(a[w] & b[w]);
  return count;
}

std::vector<Bits> agreement_graph(const std::vector<Prepared>& prepared, const Agreement& agree) {
  const int n = static_cast<int>(prepared.size());
  std::vector<Bits> graph(n, Bits((n + 63) / 64, 0));
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      if (!agree(prepared[i], prepared[j])) continue;
      put(graph[i], j);
      put(graph[j], i);
    }
  }
  return graph;
}

/// The candidate that leaves most candidates; the smallest index decides between equals. -1 if there is none.
int best_connected(const std::vector<Bits>& graph, const Bits& candidates) {
  int best = -1, best_count = -1;
  const int all_others = count_common(candidates, candidates) - 1;  // nothing leaves more than these
  for (int i = 0; i < static_cast<int>(graph.size()) && best_count < all_others; ++i) {
    if (!has(candidates, i)) continue;
    const int count = count_common(graph[i], candidates);
    if (count > best_count) {
      best = i;
      best_count = count;
    }
  }
  return best;
}

}  // namespace

double length_sigma(const StereoCamera& camera, const Eigen::Vector3d& P1, const Eigen::Vector3d& P2,
                    double De) {
  const double k = De / (camera.focal_px * camera.baseline_m);
  const Eigen::Vector3d u = P1 - P2;
  return k / u.norm() * std::sqrt(scaled_length_variance(camera.baseline_m, u, P1, P2));
}

std::vector<int> largest_consistent_set(const StereoCamera& camera, const std::vector<PointPair>& pairs,
                                        const ConsistencyOptions& options) {
  if (pairs.empty()) return {};
  std::vector<Prepared> prepared;
  prepared.reserve(pairs.size());
  for (const PointPair& pair : pairs) {
    const double De = options.image_sigma_px;
    prepared.push_back({pair, point_sigma(camera, pair.in_key, De).squaredNorm() +
                                  point_sigma(camera, pair.in_current, De).squaredNorm()});
  }
  const std::vector<Bits> graph = agreement_graph(prepared, Agreement(camera, options));
  Bits candidates((pairs.size() + 63) / 64, 0);
  for (int i = 0; i < static_cast<int>(pairs.size()); ++i) put(candidates, i);
  std::vector<int> set;
  for (int next = best_connected(graph, candidates); next >= 0; next = best_connected(graph, candidates)) {
    set.push_back(next);
    for (std::size_t w = 0; w < candidates.size(); ++w) candidates[w] &= graph[next][w];
  }
  std::sort(set.begin(), set.end());
  return set;
}

}  // namespace flogmap
