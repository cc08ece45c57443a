// SPDX-License-Identifier: MIT
// Persons: how a seed changes the designed one. Dimensions differ by about two standard deviations of those
// that Zhuang and Bradtmiller measured on 3,997 people ("Head-and-face anthropometric survey of U.S.
// respirator users", J. Occup. Environ. Hyg. 2, 2005): head breadth and length, face width at the cheekbones
// and at the angles of the jaw, face length, breadth and protrusion of the nose, length of the lips, girth of
// the neck. Those of eyes and brows differ by one and a half to two: length and height of the slit between the lids
// (means 26 to 28 and 11.6 mm, standard deviations 1.7 and 1.2; "Normative findings for periocular anthropometric
// measurements among Chinese young adults in Hong Kong", BioMed Res. Int. 2013, 821428), the distance between the inner
// corners (31.4 +- 2.5 to 38.5 +- 3.2 mm by origin, 22,638 people; a pooled analysis, PMC9029890), heights of crease
// and brow (6.4 +- 1.2 and 6.4 +- 1.8 mm; Cartwright et al., Am. J. Ophthalmol. 117, 1994).
#include <algorithm>

#include "author/generate/head/form.h"

namespace mien::head {

using author::mix;

namespace {

/// Fractions of the square roots of primes; multiples of one of them (Richtmyer's sequence) spread evenly. With random
/// numbers, some of a few dozen persons would look alike.
constexpr uint64_t kRoots[] = {
    5167115440072839076u, 4354685564936845355u, 14946468407256161813u, 6620516959819538809u,
    2270897969802886507u, 7436329637833083697u, 7640891576956012808u, 13503953896175478587u,
    11912009170470909681u, 5840696475078001361u, 11170449401992604703u, 14680500436340154072u,
    7105036623409894663u, 10473403895298186519u, 1526699215303891257u, 10282925794625328401u,
    15784041429090275239u, 12564921287827708315u, 3419155146083754954u, 7861075802853663213u,
    10035097865011968310u, 16384295103918246975u, 2037139971618630136u, 8005538875866918670u,
    15658662624704411955u, 920042818334365536u, 2746564595990239432u, 6347163684422533404u,
    8122221483861433410u, 11624138536635782868u, 4970063267203923202u, 8218451384177679172u,
    // Of eyes, brows and mouth, chosen so that no two eyes of the first dozen are alike.
    12572225172856613593u, 8523827840983335294u, 657974103417073089u, 4876166626151676799u,
    15174362533786936769u, 17060634421181079446u, 16345081216873059021u, 15131402277211729640u,
    14075873183152324219u, 10521760705816196894u, 9560662057982002852u,
    // Of properties that are picked from a few, in an order in which they go together least often in the first dozen.
    8478581677928737256u, 15131402277211729640u, 6595813211960701928u, 14840291509849589713u,
    2924174294853808894u, 3497873463625179269u};
constexpr uint32_t kFirstPick = 43;

/// 0 ... 1, 1/2 for seed 0.
double share(uint64_t seed, uint32_t i) {
  const uint64_t place = seed * kRoots[i] + (uint64_t{1} << 63);
  return static_cast<double>(place >> 11) * (1.0 / 9007199254740992.0);
}

/// -1 ... 1, 0 for seed 0; rather near the ends than near the middle, where all would look like seed 0.
double axis(uint64_t seed, uint32_t i) {
  const double even = 2 * share(seed, i) - 1;
  return even * (1.5 - 0.5 * even * even);
}

}  // namespace

Person make_person(uint64_t seed) {
  // One tone of each class of the individual typology angle, atan((L* - 50) / b*) (Chardon et al. 1991; classes
  // as in Del Bino and Bernerd, Br. J. Dermatol. 169, 2013), in an order in which neighbors in a row differ: intermediate,
  // very light, dark, brown, tan, light.
  static constexpr Color kSkins[] = {{183, 141, 119}, {207, 172, 153}, {103, 73, 60},
                                     {137, 98, 77},   {165, 122, 98},  {204, 166, 147}};
  static constexpr Color kHairs[] = {{74, 46, 32},  {28, 24, 24}, {168, 118, 62},
                                     {122, 58, 30}, {46, 34, 30}, {98, 70, 46}};
  static constexpr Color kIrises[] = {{62, 122, 138}, {98, 62, 34}, {82, 110, 66},
                                      {86, 104, 128}, {54, 36, 26}, {120, 92, 48}};
  static constexpr Color kShirts[] = {{58, 92, 122}, {150, 70, 62},  {76, 110, 84},
                                      {96, 84, 118}, {196, 150, 70}, {70, 74, 82}};
  Person p;
  uint32_t skin = 5, hair = 0, iris = 0, shirt = 0;
  uint32_t next = 0;
  const auto by = [seed, &next](double spread) { return spread * axis(seed, next++); };
  // The most visible properties first: their roots keep the first dozens of seeds farthest apart.
  p.sex = by(1);
  p.weight = by(1);
  p.breadth += by(0.125);
  p.length += by(0.135);
  p.height += by(0.125);
  p.jaw += by(0.16) + 0.05 * p.sex;
  p.chin_drop += by(1.0) + 0.25 * p.sex + 0.05;
  p.face += by(0.08);
  p.neck += by(0.06) + 0.08 * p.sex + 0.07 * p.weight;
  p.nose += by(0.24) + 0.05 * p.sex;
  p.nose_width += by(0.24);
  p.forehead += by(0.60);
  p.cheek += by(0.8);
  p.chin += by(0.35) + 0.15 * p.sex;
  p.lips += by(0.46) - 0.10 * p.sex;
  p.brow_ridge += by(0.10) + 0.14 * p.sex;
  p.muzzle += by(0.25);
  p.eyes += by(0.17) - 0.03 * p.sex;
  p.eye_tilt += by(0.105);
  p.ear += by(0.14);
  p.nose_hump += by(0.22);
  p.brow_height += by(0.40) - 0.12 * p.sex;
  p.nose_drop += by(0.36) - 0.43;
  p.tip += by(1);
  p.mouth_width += by(0.12) + 0.03 * p.sex;
  p.bridge += by(0.28) + 0.05 * p.sex;
  p.tip_drop += by(0.30) + 0.06 * p.sex;
  p.hood += by(0.30);
  p.lip_share += by(1);
  p.sockets += by(0.24) + 0.05 * p.sex;
  p.angle += by(0.28) + 0.12 * p.sex;
  p.cleft = std::max(0.0, by(0.30) - 0.14);
  p.eye_width += by(0.10);
  p.eye_gap += by(0.26);
  p.epicanthus = std::max(0.0, by(1.4) - 0.5);
  p.crease += by(0.36) - 0.20 * p.epicanthus;
  p.lower_lid += by(0.17);
  p.lid_peak += by(1);
  p.brow_arch += by(0.26) - 0.10 * p.sex;
  p.brow_slope += by(0.30);
  p.brow += by(0.36) + 0.20 * p.sex;
  p.iris_size += by(0.06);
  p.corners += by(0.12);
  if (seed != 0) {
    next = kFirstPick;
    const auto pick = [seed, &next](uint32_t count) {
      return static_cast<uint32_t>(count * share(seed, next++));
    };
    skin = pick(6);
    // Hair and eyes are mostly dark where skin is: tones 2, 3 and 4.
    static constexpr uint32_t kDarkHairs[] = {1, 4, 1, 4, 4, 1}, kDarkIrises[] = {1, 4, 4, 1, 5, 4};
    const bool dark = skin >= 2 && skin <= 4;
    hair = pick(6);
    iris = pick(6);
    if (dark) hair = kDarkHairs[hair], iris = kDarkIrises[iris];
    static constexpr HairStyle kFemale[] = {HairStyle::kBob, HairStyle::kCropped,
                                            HairStyle::kParted, HairStyle::kCurly, HairStyle::kBob},
                               kMale[] = {HairStyle::kCropped, HairStyle::kParted,
                                          HairStyle::kReceding, HairStyle::kCurly,
                                          HairStyle::kCropped};
    p.style = (p.sex < 0 ? kFemale : kMale)[pick(5)];
    shirt = pick(6);
    p.age = share(seed, next++);
    p.hood += 0.15 * p.age;
    if (p.style == HairStyle::kReceding && p.age < 0.4) p.style = HairStyle::kCropped;
  }
  p.skin = kSkins[skin];
  p.hair = mix(kHairs[hair], {158, 154, 150}, author::smooth_step(0.5, 0.95, p.age));
  p.iris = kIrises[iris];
  p.shirt = kShirts[shirt];
  p.lips *= mix(1.03, 0.80, p.age);
  // A wide jaw below a narrow face would be out of proportion.
  p.jaw = std::min(p.jaw, p.face + 0.10);
  p.brow_hair = mix(p.hair, {20, 14, 12}, 0.25);
  // Pigment hides some of the blood of lips, too.
  const double light = author::smooth_step(60, 150, p.skin.g);
  p.lip = mix(redder(mix(p.skin, {0, 0, 0}, mix(0.10, 0.06, light)), mix(0.30, 0.46, light)),
              {150, 82, 84}, 0.16);
  return p;
}

Color redder(Color c, double amount) {
  return {c.r, c.g * (1 - 0.46 * amount), c.b * (1 - 0.44 * amount)};
}

}  // namespace mien::head
