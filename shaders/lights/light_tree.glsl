// SPDX-License-Identifier: MIT
// Chooses a light by what it may send to a point, with a tree over all of them (src/pack/pack_lights.h).

/// A unit vector as three numbers of 8 bits each; of those, kNoNormal is none.
uint packNormal(vec3 n) {
  uint x = uint(n.x * 127.0f + 127.5f);
  uint y = uint(n.y * 127.0f + 127.5f);
  uint z = uint(n.z * 127.0f + 127.5f);
  return x | y << 8 | z << 16;
}

vec3 unpackNormal(uint bits) {
  return vec3(float(bits & 0xffu), float(bits >> 8 & 0xffu), float(bits >> 16)) / float(127.0) - float(1.0);
}

/// A receiver of light is a point with the normal of its surface in the form of packNormal, or kNoNormal if light comes
/// from all sides.
struct Receiver {
  vec3 point;
  vec3 normal;
  bool facing;
};

Receiver receiverOf(vec3 point, uint normal) {
  Receiver r;
  r.point = point;
  r.facing = normal != kNoNormal;
  r.normal = r.facing ? unpackNormal(normal) : vec3(0.0f);
  return r;
}

/// The row of the root.
int lightNodes() { return int(frame.emitterCount) * int(kEmitterRows) + 1; }

/// Reads a word of a list that has four words in a row.
uint lightWord(int firstRow, int index) {
  uvec4 four = readEmitters(firstRow + index / 4);
  int which = index % 4;
  return which == 0 ? four.x : which == 1 ? four.y : which == 2 ? four.z : four.w;
}

/// A node of the light tree: what the lights below it may send to a receiver, and the first child, or kLightLeaf and
/// the first emitter, with flags.
struct LightNode {
  float importance;
  uint child;
};

/// The importance is as far as a node's bounds tell: as those of Conty Estevez and Kulla (2018), but that the cosine at
/// the lights is bounded by how far they reach along their axis. Of lights in one plane, as windows are, it tells
/// whether the point is in front. 0 where none of them reaches the receiver.
LightNode lightNodeFrom(int index, Receiver to) {
  int row = lightNodes() + index * int(kLightNodeRows);
  vec4 place = uintBitsToFloat(readEmitters(row));
  uvec4 shape = readEmitters(row + 1);
  LightNode node;
  node.child = shape.w;
  node.importance = place.w;
  float radius = uintBitsToFloat(shape.z);
  if (radius < 0.0f) return node;
  vec3 away = to.point - vec3(place);
  vec3 axis = vec3(float(shape.x & 0x3ffu), float(shape.x >> 10 & 0x3ffu), float(shape.x >> 20));
  axis = axis / float(511.0) - float(1.0);
  float spread = float(shape.y & 0xffffu) / 32767.0f - 1.0f;
  float squared = dot(away, away);
  float inverse = 1.0f / sqrt(max(max(squared, radius * radius), float(1e-30)));
  float along = dot(axis, away);
  if ((shape.w & kLightBothSides) != 0u) along = abs(along);
  float cosine = 1.0f;
  if ((shape.w & kLightSharp) == 0u) {
    float front = min((along + float(shape.y >> 16) / 65535.0f * radius) * inverse, 1.0f);
    // From behind, the lights may be twice as far away as the middle of their box, or its radius.
    front *= front < 0.0f ? float(0.5) : 1.0f;
    // cos(a - b) of the angles from the axis and of the spread.
    float within = front * spread + sqrt(max(0.0f, (1.0f - front * front) * (1.0f - spread * spread)));
    cosine = front >= spread ? 1.0f : max(within, 0.0f);
  } else if (kPunctualLights && squared > radius * radius) {
    // A cone as wide as the spread and as what the node is seen under.
    float sineSeen = radius * inverse;
    float cosineSeen = sqrt(max(0.0f, 1.0f - sineSeen * sineSeen));
    float sineSpread = sqrt(max(0.0f, 1.0f - spread * spread));
    bool all = sineSpread * cosineSeen + spread * sineSeen < 0.0f;
    cosine = all || along * inverse >= spread * cosineSeen - sineSpread * sineSeen ? 1.0f : 0.0f;
  }
  // The normal is not exact.
  if (to.facing) cosine *= clamp((radius - dot(to.normal, away)) * inverse + float(0.01), 0.0f, 1.0f);
  node.importance = min(cosine * place.w * inverse * inverse, float(1e30));
  return node;
}

/// The chance that a point's light sample goes below a node rather than below its sibling.
float shareOf(LightNode node, LightNode sibling) {
  return node.importance > 0.0f ? node.importance / (node.importance + sibling.importance) : 0.0f;
}

/// The number of emitters of a leaf.
uint emittersOf(uint leaf) { return (leaf >> kLightMoreShift & (kMostLightsOfLeaf - 1u)) + 1u; }

/// Chooses an emitter by the tree, with the random number `choice`. `chance` is the probability that the light sample
/// goes to an emitter at all; the result's probability includes it.
LightChoice emitterByTree(float chance, Receiver to, uint choice, uvec2 bits) {
  uint child = readEmitters(lightNodes() + 1).w;
  float own = 1.0f;
  while ((child & kLightLeaf) == 0u && own > 0.0f) {
    int index = int(child & kLightIndex);
    LightNode first = lightNodeFrom(index, to);
    LightNode second = lightNodeFrom(index + 1, to);
    float share = shareOf(first, second);
    uint border = uint(share * 4294967040.0f);
    bool taken = choice < border || second.importance <= 0.0f;
    choice = stretchBits(choice, taken ? 0u : border, 1.0f / (taken ? share : 1.0f - share));
    own *= taken ? share : shareOf(second, first);
    child = taken ? first.child : second.child;
  }
  uint count = emittersOf(child);
  uint emitter = (child & kLightIndex) + ((choice >> 8u) * count >> 24u);
  return makeChoice(int(emitter), chance * own / float(count), bits, unitFloat(bits.x), unitFloat(bits.y));
}

/// The pdf over solid angle with which the tree chooses, from a point, the place that its ray hit on an emissive
/// triangle: a leaf knows its way to the root.
float treePdf(int slot, vec3 point, uint normal, float distance, float cosine) {
  int count = int(readEmitters(lightNodes() - 1).x);
  int parents = lightNodes() + count * int(kLightNodeRows);
  uint leaf = lightWord(parents + (count + 3) / 4, slot);
  if (leaf == kNoLightNode) return 0.0f;
  Receiver to = receiverOf(point, normal);
  int node = int(leaf);
  LightNode own = lightNodeFrom(node, to);
  float perArea = uintBitsToFloat(emitterRow(int(own.child & kLightIndex), 2).w);
  float pdf = perArea * (1.0f - frame.environmentChance) / float(emittersOf(own.child));
  while (node > 0 && pdf > 0.0f) {
    pdf *= shareOf(own, lightNodeFrom(node % 2 == 1 ? node + 1 : node - 1, to));
    node = int(lightWord(parents, node));
    if (node > 0) own = lightNodeFrom(node, to);
  }
  return pdf * distance * distance / max(cosine, float(1e-7));
}
