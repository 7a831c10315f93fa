// Built into every executable under ThreadSanitizer: what is not ours to mend.

/// OpenCV's picture codecs bring along libgdal, which takes two locks of its own in either order. Its search
/// for a board runs on threads of TBB, whose hand-over of work the sanitizer does not see; BoardDetector
/// itself has no threads.
extern "C" const char*
__tsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier): the name it is called by
extern "C" const char* __tsan_default_suppressions() {
  return "deadlock:libgdal\nrace:flogmap::BoardDetector::find\nrace:libopencv_calib3d\n";
}
