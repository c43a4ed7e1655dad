/// Found by the thread sanitizer's name for it. libpcl_io pulls in OpenNI2, which unlocks mutexes
/// that it does not hold when a program ends.
extern "C" const char* __tsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __tsan_default_suppressions() {
  return "mutex:libOpenNI2.so\n";
}
