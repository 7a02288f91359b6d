#version 450
// Where raster and walk disagree: the absolute difference of two pictures, made bright enough to see.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba16f) uniform restrict image2D picture;  // becomes the difference
layout(set = 0, binding = 1, rgba16f) uniform restrict readonly image2D other;

const float kGain = 32.0;

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(picture)))) return;
  const vec3 difference = abs(imageLoad(picture, texel).rgb - imageLoad(other, texel).rgb);
  imageStore(picture, texel, vec4(kGain * difference, 1.0));
}
