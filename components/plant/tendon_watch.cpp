#include "components/plant/tendon_watch.hpp"

namespace plant {

Tautness TendonWatch::see(double tension_N, double line_m, bool should_pull, std::int64_t now_ns) {
  if (now_ == Tautness::snapped) return now_;
  if (tension_N >= params_.slack_N || !should_pull) {
    forget();
    return now_;
  }
  if (!loose_) loose_ = true, loose_since_ns_ = now_ns, loose_line_m_ = line_m;
  if (loose_line_m_ - line_m > params_.take_up_m) now_ = Tautness::snapped;
  else if (now_ns - loose_since_ns_ >= patience_ns) now_ = Tautness::slack;
  return now_;
}

}  // namespace plant
