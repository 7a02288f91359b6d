#version 450
// Of which level of detail the cell is that a pixel shows: the colour of its chunk, as bright as the picture.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba16f) uniform restrict image2D picture;  // becomes the view of levels
layout(set = 0, binding = 1, rg32ui) uniform restrict readonly uimage2D ids;
layout(std430, set = 0, binding = 2) restrict readonly buffer Chunks {
  uint cellBits;   // FrothAssetStatus
  uint colours[];  // by chunk, as packUnorm4x8
};

const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);
const float kDarkest = 0.25;

void main() {
  const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(picture)))) return;
  const uvec2 id = imageLoad(ids, texel).xy;
  vec3 colour = vec3(0.0);
  if (id != uvec2(~0u)) {
    const uint chunk = cellBits < 32 ? id.y >> cellBits : 0;
    const float brightness = dot(imageLoad(picture, texel).rgb, kLuminance);
    colour = unpackUnorm4x8(colours[chunk]).rgb * mix(kDarkest, 1.0, min(brightness, 1.0));
  }
  imageStore(picture, texel, vec4(colour, 1.0));
}
