/// What the sanitizers ask for under these names: what of other libraries they take for an error.
/// Weak, because every target of a program has them.
// NOLINTBEGIN(bugprone-reserved-identifier)

/// libpcl_io pulls in OpenNI2, which unlocks mutexes that it does not hold when a program ends; LCM
/// locks between its threads inside GLib, which the sanitizer does not see through; what a shared
/// pointer of spdlog held is destroyed when the count, which it does not see either, is down.
extern "C" [[gnu::weak]] const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
  return "mutex:libOpenNI2.so\n"
         "mutex:libglib-2.0.so\n"
         "race:libglib-2.0.so\n"
         "race:liblcm.so\n"
         "race:spdlog::logger::~logger\n";
}

/// Fontconfig keeps offsets where the sanitizer looks for pointers, so that the font that Cairo
/// still holds when a program ends looks lost.
extern "C" [[gnu::weak]] const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig.so\n";
}
// NOLINTEND(bugprone-reserved-identifier)
