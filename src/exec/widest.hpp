// One source, compiled for several widths of register; the machine at hand chooses. IEEE operations give the same bits at
// any width.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define GRAINRAY_X86_LEVELS 1
#endif

namespace grainray::cpu {
namespace levels {

template <class Work>
void plain(const Work& work) { work.template operator()<4>(); }
#ifdef GRAINRAY_X86_LEVELS
template <class Work>
[[gnu::target("arch=x86-64-v3")]] void v3(const Work& work) { work.template operator()<8>(); }
template <class Work>
[[gnu::target("arch=x86-64-v4")]] void v4(const Work& work) { work.template operator()<16>(); }
#endif

}  // namespace levels

/// work.operator()<L>(), L the floats of a register. The operator and all it calls must be inlined, [[gnu::always_inline]].
template <class Work>
void with_widest_registers(const Work& work) {
#ifdef GRAINRAY_X86_LEVELS
    if (__builtin_cpu_supports("x86-64-v4")) return levels::v4(work);
    if (__builtin_cpu_supports("x86-64-v3")) return levels::v3(work);
#endif
    levels::plain(work);
}

}  // namespace grainray::cpu
