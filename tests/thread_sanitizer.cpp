/// Found by the thread sanitizer's name for it. libpcl_io pulls in OpenNI2, which unlocks mutexes
/// that it does not hold when a program ends; LCM locks between its threads inside GLib, which the
/// sanitizer does not see through. Weak, because every target of a program has it.
// NOLINTNEXTLINE(bugprone-reserved-identifier)
extern "C" [[gnu::weak]] const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
  return "mutex:libOpenNI2.so\n"
         "mutex:libglib-2.0.so\n"
         "race:libglib-2.0.so\n"
         "race:liblcm.so\n";
}
