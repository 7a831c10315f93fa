// Built into every executable under ThreadSanitizer: what is not ours to mend.

/// OpenCV's picture codecs bring along libgdal, which takes two locks of its own in either order.
extern "C" const char*
__tsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier): the name it is called by
extern "C" const char* __tsan_default_suppressions() { return "deadlock:libgdal\n"; }
