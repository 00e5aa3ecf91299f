// SPDX-License-Identifier: MIT
// The choice of a light sample among emitters and the environment, and its chance.

/// The chance that a point's light sample is one of an emitter or, kFromEnvironment, of the environment; 1 for what no
/// ray can find.
float chanceOfLight(int emitter, vec3 point, uint normal) {
  if (emitter == kFromEnvironment) return frame.environmentChance;
  uint kind = emitterRow(emitter, 3).w;
  if (isPunctual(kind)) return 1.0f;
  if (!kLightTree) return uintBitsToFloat(emitterRow(emitter, 0).w) * (1.0f - frame.environmentChance);
  return treePdf(int(kind), point, normal, 1.0f, 1.0f) / uintBitsToFloat(emitterRow(emitter, 2).w);
}

/// The number of light samples that each shaded point takes: one with global illumination; else one of each punctual
/// light, and one of the emissive triangles.
int lightSampleCount() {
  if (kGi) return hasLamps() || kEnvironmentSampling ? 1 : 0;
  return punctualLightCount() + (kEmissiveTriangles ? 1 : 0);
}

/// The random numbers that draw a light of global illumination (kLightTree), and a point or direction of it.
struct LightNumbers {
  uint choice;
  uvec2 bits;
  float time;  // time of the path (kMoving)
};

LightNumbers lightNumbers(Sampler sampler, uint dimension) {
  LightNumbers n;
  n.choice = kLightTree ? drawBits(sampler, dimension) : 0u;
  n.bits = drawPairBits(sampler, dimension + 1u);
  n.time = kMoving ? timeOf(sampler) : 0.0f;
  return n;
}

/// The choice of these numbers for a point of global illumination.
LightChoice chooseLight(LightNumbers n, vec3 point, uint normal) {
  float chance = frame.environmentChance;
  LightChoice c = makeChoice(kFromEnvironment, chance, n.bits, 0.0f, 0.0f);
  bool environment = kEnvironmentSampling;
  if (kEnvironmentSampling && hasLamps()) {
    // The choice uses up part of the number; the rest is stretched, so each side stays stratified.
    uint border = uint(chance * 4294967040.0f);
    environment = c.bits.x < border;
    c.bits.x = environment ? stretchBits(c.bits.x, 0u, 1.0f / chance)
                           : stretchBits(c.bits.x, border, 1.0f / (1.0f - chance));
  }
  if (hasLamps() && !environment) {
    c = kLightTree ? emitterByTree(1.0f - chance, receiverOf(point, normal), n.choice, c.bits)
                   : emitterByPower(1.0f - chance, c.bits);
  }
  if (kMoving) c.time = n.time;
  return c;
}

/// The light sample of a choice.
LightSample lightOfChoice(LightChoice c, vec3 point) {
  LightSample s = noLight();
  if (kSun && c.emitter == kFromEnvironment) return skyLight(c.chance, c.bits);
  if (kEnvironmentSampling && c.emitter == kFromEnvironment) s = environmentLight(c.chance, c.bits);
  if (hasLamps() && c.emitter != kFromEnvironment)
    s = lightOfEmitter(c.emitter, c.chance, point, c.u, c.v, false, c.time);
  return s;
}

/// The light sample of global illumination that these numbers draw.
LightSample lightFrom(LightNumbers n, vec3 point, uint normal) {
  return lightOfChoice(chooseLight(n, point, normal), point);
}

/// One of the lightSampleCount() samples; uses four dimensions from `dimension` on. normal: that of a surface
/// which takes light from one side only (Receiver), else kNoNormal.
LightSample sampleLight(int index, vec3 point, uint normal, Sampler sampler, uint dimension) {
  if (kGi) return lightFrom(lightNumbers(sampler, dimension), point, normal);
  int punctual = punctualLightCount();
  LightSample s = noLight();
  if (kPunctualLights && index < punctual) s = punctualLight(index, point);
  float time = kMoving ? timeOf(sampler) : 0.0f;
  if (kEmissiveTriangles && index == punctual)
    s = emitterLight(1.0f, point, drawPairBits(sampler, dimension), true, time);
  return s;
}
