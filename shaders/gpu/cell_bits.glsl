// Reads what a live cell shows from its bits, whose order runtime/asset/cell_packer.h tells. All but octahedral normals
// are the floats of the asset, bit for bit: a code times a power of two.
#ifndef FROTH_GPU_CELL_BITS_GLSL
#define FROTH_GPU_CELL_BITS_GLSL
#include "gpu/asset.glsl"

struct BitCursor {
  UintArray words;
  uint wordCount;
  uint word, bit;
};

void skipBits(inout BitCursor cursor, uint count) {
  uint end = cursor.bit + count;
  cursor.word += end / 32;
  cursor.bit = end % 32;
}

// width 0..32
uint takeBits(inout BitCursor cursor, uint width) {
  uint low = cursor.words.v[checked(cursor.word, cursor.wordCount)] >> cursor.bit;
  uint high = cursor.words.v[checked(cursor.word + 1, cursor.wordCount)] << 1 << (31 - cursor.bit);
  skipBits(cursor, width);
  return width > 0 ? (low | high) & (0xffffffffu >> (32 - width)) : 0;
}

// The lowest bits as two's complement of width 0..31.
int signedOf(uint bits, uint width) {
  uint sign = (1u << width) >> 1;
  return int(bits & ((1u << width) - 1) ^ sign) - int(sign);
}

int takeSigned(inout BitCursor cursor, uint width) { return signedOf(takeBits(cursor, width), width); }

vec3 takeFloats(inout BitCursor cursor) {
  float x = uintBitsToFloat(takeBits(cursor, 32));
  float y = uintBitsToFloat(takeBits(cursor, 32));
  float z = uintBitsToFloat(takeBits(cursor, 32));
  return vec3(x, y, z);
}

ivec3 takeSignedTriple(inout BitCursor cursor, uint firstWidth, uint otherWidth) {
  uint width = firstWidth + 2 * otherWidth;
  if (width < 32) {  // as almost always: read once
    uint bits = takeBits(cursor, width);
    uint otherBits = bits >> firstWidth;
    return ivec3(signedOf(bits, firstWidth), signedOf(otherBits, otherWidth), signedOf(otherBits >> otherWidth, otherWidth));
  }
  int x = takeSigned(cursor, firstWidth);
  int y = takeSigned(cursor, otherWidth);
  int z = takeSigned(cursor, otherWidth);
  return ivec3(x, y, z);
}

// A colour from green, red - green, blue - green.
vec3 joinGreen(ivec3 code, float unit) { return unit * vec3(code.x + code.y, code.x, code.x + code.z); }

// What stands before a cell's detail sites.
struct CellHeader {
  float unit;  // 2^scale of the colours
  uint place, height, lobes, axis;  // widths
  uvec2 base, lobe;                 // widths of green and of chroma
  int lowestHeight;
  ivec3 lowestBase;
  BitCursor ownAxes;
  BitCursor lobeCounts;
};

BitCursor cellBits(uint chunk, uint cell) {
  uint start = FRAME.chunks.v[chunk].cellStarts.v[checked(cell, FRAME.chunks.v[chunk].liveCount)];
  return BitCursor(FRAME.chunks.v[chunk].cellWords, FRAME.chunks.v[chunk].cellWordCount, start / 4, start % 4 * 8);
}

float takeDensity(CellCode code, inout BitCursor cursor) {
  return uintBitsToFloat((takeBits(cursor, code.densityBits) + code.densityLowest) << code.densityShift);
}

// The quaternion of orientationOfNormal (format/quantization.h). In whole numbers up to the normal's length, so that an
// index pair is the same normal everywhere.
vec4 orientationOfNormal(int y, int z, bool isBack, int halfRange) {
  int x = halfRange - abs(y) - abs(z);
  vec3 normal = vec3(x, y, z);
  if (x < 0) {
    normal.y = float(y < 0 ? abs(z) - halfRange : halfRange - abs(z));
    normal.z = float(z < 0 ? abs(y) - halfRange : halfRange - abs(y));
  }
  normal = normalize(normal);
  float w = sqrt((1.0 + abs(normal.x)) / 2.0);
  float scale = 0.5 / w;
  if (isBack) return vec4(-normal.y * scale, normal.z * scale, 0.0, w);
  return vec4(w, 0.0, normal.z * scale, -normal.y * scale);
}

vec4 takeOrientation(CellCode code, inout BitCursor cursor) {
  if (code.normalBits == 0) {
    vec3 wxy = takeFloats(cursor);
    return vec4(wxy, uintBitsToFloat(takeBits(cursor, 32)));
  }
  bool isBack = takeBits(cursor, 1) != 0;
  int halfRange = int(1u << (code.normalBits - 1)) - 1;
  int y = int(takeBits(cursor, code.normalBits)) - halfRange;
  int z = int(takeBits(cursor, code.normalBits)) - halfRange;
  return orientationOfNormal(y, z, isBack, halfRange);
}

struct Frame {
  vec3 normal, tangent, bitangent;
};

// The rows of the rotation matrix of a unit quaternion (w, x, y, z).
Frame frameOf(vec4 quaternion) {
  float w = quaternion.x, x = quaternion.y, y = quaternion.z, z = quaternion.w;
  return Frame(vec3(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
               vec3(2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
               vec3(2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)));
}

Frame takeFrame(CellCode code, inout BitCursor cursor) { return frameOf(takeOrientation(code, cursor)); }

CellHeader loadCellHeader(CellCode code, uint chunk, uint cell) {
  BitCursor cursor = cellBits(chunk, cell);
  skipBits(cursor, code.densityBits + (code.normalBits > 0 ? 2 * code.normalBits + 1 : 128u));
  CellHeader header;
  header.unit = float(1u << takeBits(cursor, code.scaleBits));
  header.place = takeBits(cursor, code.widthBits);
  header.height = takeBits(cursor, code.widthBits);
  header.base.x = takeBits(cursor, code.widthBits);
  header.base.y = takeBits(cursor, code.widthBits);
  header.lobes = takeBits(cursor, code.widthBits);
  header.axis = takeBits(cursor, code.widthBits);
  header.lobe.x = takeBits(cursor, code.widthBits);
  header.lobe.y = takeBits(cursor, code.widthBits);
  header.lowestHeight = takeSigned(cursor, code.heightBits);
  header.lowestBase = takeSignedTriple(cursor, code.baseBits, code.baseBits);
  uint ownAxes = takeBits(cursor, code.ownAxisBits);
  header.ownAxes = cursor;
  skipBits(cursor, ownAxes * 3 * code.axisBits);
  header.lobeCounts = cursor;
  return header;
}

struct DetailSite {
  vec2 place;
  float height;
  vec3 base;
};

DetailSite loadDetailSite(CellCode code, CellHeader header, uint detailCount, uint detail) {
  BitCursor cursor = header.lobeCounts;
  uint detailBits = 2 * header.place + header.height + header.base.x + 2 * header.base.y;
  skipBits(cursor, detailCount * header.lobes + detail * detailBits);
  DetailSite detailSite;
  if (code.placeStep > 0.0) {
    detailSite.place.x = code.placeStep * float(takeSigned(cursor, header.place));
    detailSite.place.y = code.placeStep * float(takeSigned(cursor, header.place));
  } else {
    detailSite.place.x = uintBitsToFloat(takeBits(cursor, 32));
    detailSite.place.y = uintBitsToFloat(takeBits(cursor, 32));
  }
  uint height = takeBits(cursor, header.height);
  detailSite.height = code.heightStep > 0.0
                    ? code.heightStep * float(header.lowestHeight + int(height))
                    : uintBitsToFloat(height);
  if (code.baseStep > 0.0) {
    int green = int(takeBits(cursor, header.base.x));
    int redLess = int(takeBits(cursor, header.base.y));
    int blueLess = int(takeBits(cursor, header.base.y));
    detailSite.base = joinGreen(header.lowestBase + ivec3(green, redLess, blueLess), code.baseStep * header.unit);
  } else {
    detailSite.base = takeFloats(cursor);
  }
  return detailSite;
}

// The lobes of one detail site, to be taken one after the other.
struct Lobes {
  BitCursor cursor;
  uint count;
};

Lobes noLobes(CellHeader header) { return Lobes(header.lobeCounts, 0u); }

Lobes loadLobes(CellCode code, CellHeader header, uint detailCount, uint detail) {
  BitCursor counts = header.lobeCounts;
  uint before = 0;
  for (uint k = 0; k < detail; ++k) before += takeBits(counts, header.lobes);
  Lobes lobes;
  lobes.count = takeBits(counts, header.lobes);
  lobes.cursor = header.lobeCounts;
  uint detailBits = header.lobes + 2 * header.place + header.height + header.base.x + 2 * header.base.y;
  uint lobeBits = (code.axisCount > 0 ? 1 : 3) * header.axis + header.lobe.x + 2 * header.lobe.y;
  skipBits(lobes.cursor, detailCount * detailBits + before * lobeBits);
  return lobes;
}

// Where there is a step.
ivec3 takeAxisCode(CellCode code, CellHeader header, inout Lobes lobes) {
  if (code.axisCount == 0) return takeSignedTriple(lobes.cursor, header.axis, header.axis);
  uint label = takeBits(lobes.cursor, header.axis);
  BitCursor axis = header.ownAxes;
  if (label < code.axisCount) {
    axis.word = 0;
    axis.bit = 0;
  } else {
    label -= code.axisCount;
  }
  skipBits(axis, label * 3 * code.axisBits);
  return takeSignedTriple(axis, code.axisBits, code.axisBits);
}

vec3 takeAxis(CellCode code, CellHeader header, inout Lobes lobes) {
  if (!(code.axisStep > 0.0)) return takeFloats(lobes.cursor);
  return code.axisStep * vec3(takeAxisCode(code, header, lobes));
}

ivec3 takeLobeColourCode(CellHeader header, inout Lobes lobes) {
  return takeSignedTriple(lobes.cursor, header.lobe.x, header.lobe.y);
}

vec3 takeLobeColour(CellCode code, CellHeader header, inout Lobes lobes) {
  if (!(code.colourStep > 0.0)) return takeFloats(lobes.cursor);
  return joinGreen(takeLobeColourCode(header, lobes), code.colourStep * header.unit);
}

#endif
