// SPDX-License-Identifier: MIT
// Which names mean the same control. The only such table: libraries, program and bindings all use it,
// through mien_rig_match() and mien_control_name().
//
// The name comes first, then its aliases in lower case, without separators. `*` stands for no side, left or right:
// names of ARKit say Left and Right, `/` is the same for those of MetaHuman, which say L and R. `<` and `>` stand
// for left and right. Aliases are those of Unified Expressions, VRM, FACS (AU12), MetaHuman's raw controls,
// MakeHuman's targets, and words that sculptors use. docs/face-capture.md, 2 "Names" has the rules.
#pragma once

namespace mien {

struct AliasRow {
  const char* name;
  const char* aliases;
};

constexpr AliasRow kAliases[] = {
    // ARKit.
    {"eyeBlink*",
     "eyeclosed* eyeclose* eyesclosed eyesclose blink* au45* au43* au46* eyeclosure* lidclose*"},
    {"eyeLookDown*", "lookdown* au64* eyesdown"},
    {"eyeLookInLeft", "eyelookright< au62<"},
    {"eyeLookOutLeft", "eyelookleft< au61<"},
    {"eyeLookInRight", "eyelookleft> au61>"},
    {"eyeLookOutRight", "eyelookright> au62>"},
    {"eyeLookUp*", "lookup* au63* eyesup"},
    {"eyeSquint*", "eyesquintinner* au7* lidtightener* lidtighten* squint*"},
    {"eyeWide*", "eyewiden* eyesurprised* au5* upperlidraiser* eyeopenedup* eyesurprise*"},
    {"jawForward", "jawfwd jawthrust au29"},
    {"jawLeft", "au30< jawsideways<"},
    {"jawRight", "au30> jawsideways>"},
    {"jawOpen", "au26 jawdrop mouthopen openmouth"},
    {"mouthClose", "mouthclosed lipstowardeachother au8"},
    {"mouthFunnel", "lipfunnel lipfunneler mouthfunneler au22"},
    {"mouthPucker", "lippucker lippuckerer pucker kiss au18 mouthpursing"},
    {"mouthLeft", "mouthmove<"},
    {"mouthRight", "mouthmove>"},
    {"mouthSmile*",
     "mouthcornerpull* lipcornerpuller* lipcornerpull* smile* au12* mouthcornerpuller*"},
    {"mouthFrown*",
     "mouthcornerdepress* lipcornerdepressor* lipcornerdepress* frown* au15* mouthsad*"},
    {"mouthDimple*", "dimpler* dimple* au14* mouthdimpler*"},
    {"mouthStretch*", "lipstretcher* lipstretch* au20* mouthretraction*"},
    {"mouthRollLower", "lipsucklower liprolllower"},
    {"mouthRollUpper", "lipsuckupper liprollupper"},
    {"mouthShrugLower", "mouthraiserlower chinraiserlower chinraiser chinraise au17 jawchinraised"},
    {"mouthShrugUpper", "mouthraiserupper chinraiserupper jawchinraiseu"},
    {"mouthPress*", "lippress* lippressor* lipspress* au24*"},
    {"mouthLowerDown*", "mouthlowerlipdepress* lowerlipdepressor* lowerlipdepress* au16*"},
    {"mouthUpperUp*", "mouthupperlipraise* upperlipraiser* upperlipraise* au10*"},
    {"browDown*", "browlowerer* browlower* browsdown au4* eyebrowsdown* eyebrowdown*"},
    {"browInnerUp*", "innerbrowraiser* innerbrowraise* au1* eyebrowsinnerup* eyebrowinnerup*"},
    {"browOuterUp*",
     "browraiseouter* outerbrowraiser* outerbrowraise* au2* eyebrowsexternup* eyebrowouterup*"},
    {"cheekPuff*", "cheekblow* mouthcheekblow* cheekspuff au34* au33*"},
    {"cheekSquint*", "eyecheekraise* cheekraiser* cheekraise* au6*"},
    {"noseSneer*", "nosewrinkle* nosewrinkler* sneer* au9* noseelevation*"},
    {"tongueOut", "tongueshow tonguestickout au19"},
    // MetaHuman's raw controls that ARKit has no name for.
    {"browLateral/", "browpinch*"},
    {"eyePupilWide/", "eyedilation* pupildilate*"},
    {"eyePupilNarrow/", "eyeconstrict* pupilconstrict*"},
    {"noseNostrilDilate/", "nasaldilation* nostrildilator* nostrildilate* au38* nosedilatation*"},
    {"noseNostrilCompress/",
     "nasalconstrict* nostrilcompressor* nostrilcompress* au39* nosecompression*"},
    {"noseNasolabialDeepen/", "mouthupperdeepen* nasolabialdeepener* nasolabialdeepen* au11*"},
    {"mouthCheekSuck/", "cheeksuck* au35*"},
    {"jawBack", "jawbackward jawretract"},
    {"jawClench/", "jawclencher* au31*"},
    {"jawOpenExtreme", "au27 mouthstretchopen"},
    {"mouthUpperLipRollIn/", "lipsuckupper*"},
    {"mouthLowerLipRollIn/", "lipsucklower*"},
    {"mouthLowerLipBite/", "lipbite* au32*"},
    {"mouthFunnelU/", "lipfunnelupper*"},
    {"mouthFunnelD/", "lipfunnellower*"},
    {"mouthLipsPurseU/", "lippuckerupper*"},
    {"mouthLipsPurseD/", "lippuckerlower*"},
    {"mouthUpperLipShiftLeft", "mouthupper<"},
    {"mouthUpperLipShiftRight", "mouthupper>"},
    {"mouthLowerLipShiftLeft", "mouthlower<"},
    {"mouthLowerLipShiftRight", "mouthlower>"},
    {"mouthSharpCornerPull/", "mouthcornerslant* sharplippuller* au13*"},
    {"tongueBendUp", "tonguecurlup"},
    {"tongueNarrow", "tonguesquish"},
    {"tongueThin", "tongueflat"},
    {"neckSwallowPh2", "throatswallow swallow au80"},
    {"neckStretch/", "neckflex* necktightener* au21* neckplatysma*"},
};

/// An expression of a vocabulary that is several controls, beside those of arkit_table.h. VRM, and action units that have
/// no control of their own on either side of the face.
struct ExpressionShare {
  const char* expression;  // in lower case, without separators; `<` and `>` for a side
  const char* control;
  float weight;
};

constexpr ExpressionShare kExpressionShares[] = {
    {"look<", "eyeLookOutLeft", 1},
    {"look<", "eyeLookInRight", 1},
    {"look>", "eyeLookInLeft", 1},
    {"look>", "eyeLookOutRight", 1},
    {"eyelook<", "eyeLookOutLeft", 1},
    {"eyelook<", "eyeLookInRight", 1},
    {"eyelook>", "eyeLookInLeft", 1},
    {"eyelook>", "eyeLookOutRight", 1},
    {"eyeslook<", "eyeLookOutLeft", 1},
    {"eyeslook<", "eyeLookInRight", 1},
    {"eyeslook>", "eyeLookInLeft", 1},
    {"eyeslook>", "eyeLookOutRight", 1},
    {"au61", "eyeLookOutLeft", 1},
    {"au61", "eyeLookInRight", 1},
    {"au62", "eyeLookInLeft", 1},
    {"au62", "eyeLookOutRight", 1},
    {"au23", "mouthLipsTightenUL", 1},
    {"au23", "mouthLipsTightenUR", 1},
    {"au23", "mouthLipsTightenDL", 1},
    {"au23", "mouthLipsTightenDR", 1},
    {"au28", "mouthRollLower", 1},
    {"au28", "mouthRollUpper", 1},
    {"aa", "jawOpen", 0.6f},
    {"ih", "jawOpen", 0.2f},
    {"ih", "mouthSmileLeft", 0.3f},
    {"ih", "mouthSmileRight", 0.3f},
    {"ou", "mouthPucker", 0.75f},
    {"ou", "jawOpen", 0.15f},
    {"ee", "mouthStretchLeft", 0.4f},
    {"ee", "mouthStretchRight", 0.4f},
    {"ee", "jawOpen", 0.2f},
    {"oh", "jawOpen", 0.4f},
    {"oh", "mouthFunnel", 0.6f},
};

}  // namespace mien
