// SPDX-License-Identifier: MIT
// Skin under lamps: softer than chalk at the edge of light, and redder there, because red light goes farthest under it.
// Its shine is a sharp lobe on a soft one. Both as in render/light.cpp, for a cheek.
import { ShaderChunk } from "three";

const SKIN = `
// A cosine that ends softly: each color is blurred around the terminator (Penner 2011, "Pre-integrated skin shading").
vec3 skinFalloff(const in float cosine) {
	const vec3 around = vec3(0.66, 0.50, 0.46);
	vec3 soft = max(vec3(cosine) + around, 0.0);
	return mix(soft * soft / (4.0 * around), vec3(max(cosine, 0.0)), step(around, vec3(cosine)));
}

vec3 skinShine(const in vec3 light, const in vec3 view, const in vec3 normal, const in PhysicalMaterial material) {
	PhysicalMaterial film = material;
	film.roughness = min(2.0 * material.roughness + 0.1, 1.0);
	return 0.7 * (0.55 * BRDF_GGX(light, view, normal, material) + 0.45 * BRDF_GGX(light, view, normal, film));
}
`;
const CHUNK = "lights_physical_pars_fragment";
const LIGHTS = ShaderChunk[CHUNK].replace("void RE_Direct_Physical(", `${SKIN}$&`)
  .replace("reflectedLight.directSpecular += irradiance * BRDF_GGX(", "reflectedLight.directSpecular += irradiance * skinShine(")
  .replace("reflectedLight.directDiffuse += irradiance *",
    "reflectedLight.directDiffuse += skinFalloff( dot( geometryNormal, directLight.direction ) ) * directLight.color *");

/** Makes a MeshStandardMaterial that of skin. */
export function asSkin(material) {
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(`#include <${CHUNK}>`, LIGHTS);
  };
  material.customProgramCacheKey = () => "skin";
  return material;
}
