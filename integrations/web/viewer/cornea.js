// SPDX-License-Identifier: MIT
// The iris as it is seen through the cornea, as in render/cornea.cpp: the line of sight is refracted where it enters the
// eye, and goes on to the plane of the iris (Jimenez 2013, "Next-generation character rendering", GDC).

// Lengths are in radii of the iris. The frame of the eye comes from the slope of the texture coordinates and from the
// sphere of the cornea, 7.8 mm where the iris has 5.9 mm, so that it needs no more than the texture.
const EYE = (depth, iris) => `
const float corneaDepth = ${depth.toFixed(5)};
const float corneaIris = ${iris.toFixed(5)};
const float corneaRadius = 1.32;

// Where the color texture is looked up; z: how clear the cornea is, 0 to 1.
vec3 corneaPlace(const in vec2 at) {
	vec3 place = - vViewPosition, normal = normalize(vNormal), toEye = normalize(vViewPosition);
	vec3 px = dFdx(place), py = dFdy(place);
	vec2 ux = dFdx(at), uy = dFdy(at);
	vec3 qx = cross(py, normal), qy = cross(normal, px);
	float det = dot(px, qx);
	vec2 from = at - 0.5;
	float r = length(from) / corneaIris;
	float clear = smoothstep(0.0, 1.0, (1.06 - r) / 0.14);
	if (clear == 0.0 || det == 0.0) return vec3(at, 0.0);
	vec3 slopeU = (qx * ux.x + qy * uy.x) / det, slopeV = (qx * ux.y + qy * uy.y) / det;
	// Away from the middle, and around it, where the texture has its true size.
	vec3 outward = slopeU * from.x + slopeV * from.y;
	outward = normalize(length(outward) > 1e-4 * length(slopeU) ? outward : slopeU);
	vec3 around = cross(normal, outward);
	vec2 uvAround = vec2(dot(slopeU, around), dot(slopeV, around));
	vec2 uvOut = vec2(dot(slopeU, outward), dot(slopeV, outward));
	float size = length(uvAround);
	uvOut *= size / length(uvOut);
	float sine = min(r / corneaRadius, 0.95), cosine = sqrt(1.0 - sine * sine);
	vec3 axis = normal * cosine - outward * sine, radial = normal * sine + outward * cosine;
	vec3 ray = refract(- toEye, normal, 1.0 / 1.336); // the index of the aqueous humor in Gullstrand's eye
	float height = max(corneaDepth - corneaRadius * (1.0 - cosine), 0.0) * corneaIris / size;
	vec3 way = ray * (height / max(- dot(ray, axis), 0.2));
	// Pictures of irises are taken through a cornea, which shows them 1.09 times as large.
	vec2 seen = 1.09 * (from + uvOut * dot(way, radial) + uvAround * dot(way, around));
	// Beside the iris is its root, as dark as its border.
	seen *= min(1.0, 0.97 * corneaIris / max(length(seen), 1e-6));
	return vec3(0.5 + seen, clear);
}
`;
const MAP = "#include <map_fragment>";
const LOOK_UP = `
	vec3 seenIris = corneaPlace(vMapUv);
	vec4 sampledDiffuseColor = mix(texture2D(map, vMapUv),
		textureGrad(map, seenIris.xy, dFdx(vMapUv), dFdy(vMapUv)), seenIris.z);
	diffuseColor *= sampledDiffuseColor;
`;

// A GLB may say anything; in materials files these are the limits of the program, too.
const isWithin = (value, most) => typeof value === "number" && value > 0 && value <= most;

/** Makes a MeshStandardMaterial with a texture that of an eye: `depth` of the iris behind the apex of the cornea, in its
 * radii, and `iris`, that radius in the texture, whose middle it is in. */
export function asEye(material, { depth, iris }) {
  if (!isWithin(depth, 1) || !isWithin(iris, 0.5) || !material.map) return material;
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace("void main() {", `${EYE(depth, iris)}$&`).replace(MAP, LOOK_UP);
  };
  material.customProgramCacheKey = () => `eye ${depth} ${iris}`;
  return material;
}
