// Undoes prelude.h.
#undef FOAM_FN
#undef FOAM_OUT
#undef FOAM_INOUT
#undef FOAM_PRECISE
#undef real2
#undef real3
#undef real4
#if defined(__cplusplus)
}  // namespace froth::foam
#else
#undef real
#endif
