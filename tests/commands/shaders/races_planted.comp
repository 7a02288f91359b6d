// Small uses of shared memory, by the name of a case that is defined: workgroup_races_test.cpp tells which of them are
// races.
#version 460
#extension GL_EXT_buffer_reference : require

const uint kThreads = 64;
layout(local_size_x = kThreads) in;

layout(buffer_reference) buffer Numbers { uint v[]; };
layout(push_constant) uniform Push { Numbers numbers; } push;

shared uint places[kThreads];
shared uint one;

void main() {
  uint thread = gl_LocalInvocationIndex;
  uint number = push.numbers.v[thread];
#if defined(OWN_PLACE)
  places[thread] = number;
  number = places[thread];
#elif defined(OTHERS_PLACE)
  places[thread] = number;
  number = places[kThreads - 1 - thread];
#elif defined(UNKNOWN_PLACE)
  places[thread] = number;
  number = places[number];
#elif defined(LOAD_BEFORE_STORE)
  number = places[number];
  places[thread] = number;
#elif defined(ONE_THREAD)
  if (thread == 0) one = number;
  if (thread < 1) number = one;
#elif defined(ONE_STORES)
  if (thread == 0) one = number;
  number = one;
#elif defined(ONE_STORES_BEFORE_BARRIER)
  if (thread == 0) one = number;
  barrier();
  number = one;
#elif defined(BRANCHES)
  if (thread == 0) one = number;
  else number = one;
#elif defined(ALL_STORE)
  one = number;
#elif defined(ATOMICS)
  atomicAdd(one, number);
  atomicMax(one, number);
#elif defined(ATOMIC_AND_LOAD)
  atomicAdd(one, number);
  number = one;
#elif defined(HALVES) || defined(HALVES_WITHOUT_BARRIER)
  places[thread] = number;
  for (uint stride = kThreads / 2; stride > 0; stride /= 2) {
#if defined(HALVES)
    barrier();
#endif
    if (thread < stride) places[thread] += places[thread + stride];
  }
#elif defined(ROUNDS) || defined(ROUNDS_WITHOUT_BARRIER)
  for (uint round = 0; round < push.numbers.v[0]; ++round) {
    places[thread] = number;
    barrier();
    number += places[kThreads - 1 - thread];
#if defined(ROUNDS)
    barrier();
#endif
  }
#elif defined(SOME_MEET)
  if (thread < 32) barrier();
#else
#error which case?
#endif
  push.numbers.v[thread] = number;
}
