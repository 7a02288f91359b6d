// Foam and motes along a ray, and shadows of meshes on the foam. After foam_rays.glsl.

// The photos' light is baked into the foam's colours. The model: what was photographed was lit as this room is, by the
// surrounding light and by the sun, unshadowed. Where a mesh stands in the sun, its part is taken out again.
vec3 caughtShadow(vec3 position, vec3 normal) {
  vec3 surround = surroundingLight(normal);
  vec3 sun = room.sun.rgb * max(dot(normal, room.toSun.xyz), 0.0);
  vec3 kept = (surround + sunPastMeshes(position, normal) * sun) / (surround + sun);
  return mix(vec3(1.0), kept, room.numbers.z);
}

struct Mote {
  float t;
  vec4 colour;  // premultiplied
};

// The next mote along a ray behind `after`: soft discs that face the ray, where it passes their centres.
bool findMote(FrothRay ray, float after, out Mote mote) {
  mote = Mote(ray.tMax, vec4(0.0));
  bool isFound = false;
  for (int i = 0; i < room.counts.x; ++i) {
    vec4 place = room.particles[i].place;
    vec3 offset = place.xyz - ray.origin;
    float t = dot(offset, ray.direction);
    vec3 across = offset - t * ray.direction;
    float fade = 1.0 - dot(across, across) / (place.w * place.w);
    if (fade <= 0.0 || t <= after || t >= mote.t) continue;
    vec4 colour = room.particles[i].colour;
    float cover = colour.w * fade * fade;
    mote = Mote(t, vec4(cover * colour.rgb, cover));
    isFound = true;
  }
  return isFound;
}

// Premultiplied linear light of foam and motes along a ray: the foam in segments from mote to mote.
vec4 foamAndMotes(FrothRay ray) {
  vec3 foam = vec3(0.0), motes = vec3(0.0);
  float through = 1.0, after = ray.tMin;
  FrothWalk walk;
  if (hasFoam()) walk = frothBeginWalk(ray);
  Mote mote;
  for (bool isMote = true; isMote;) {
    isMote = findMote(ray, after, mote);
    vec4 segment = hasFoam() ? frothRadianceSegment(walk, mote.t) : vec4(0.0);
    foam += through * segment.rgb;
    through *= 1.0 - segment.w;
    motes += through * mote.colour.rgb;
    through *= 1.0 - mote.colour.w;
    after = mote.t;
  }
  if (hasFoam() && walk.hit.distance < kFar) {
    foam *= caughtShadow(ray.origin + walk.hit.distance * ray.direction, walk.hit.normal);
  }
  return vec4(foam + motes, 1.0 - through);
}
