// Draws views of a scene by three.js. three.py serves this page's files and calls drawScene.
import * as THREE from 'three';
import { EXRExporter } from 'three/addons/exporters/EXRExporter.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

// Lamps of one side are spots of 180 degrees here. Their light falls off by the cosine, as a small flat lamp's does.
THREE.ShaderChunk.lights_pars_begin = THREE.ShaderChunk.lights_pars_begin.replace(
    'return smoothstep( coneCosine, penumbraCosine, angleCosine );',
    'return coneCosine < 1e-6 ? max( angleCosine, 0.0 ) : smoothstep( coneCosine, penumbraCosine, angleCosine );');
if (!THREE.ShaderChunk.lights_pars_begin.includes('coneCosine < 1e-6'))
    throw new Error('three.mjs: wanted the function of spots of three.js 0.187, found another');

const shadowEdge = 2048;

function isMirror(mesh) {
    const materials = Array.isArray(mesh.material) ? mesh.material : [mesh.material];
    return materials.some(material => material.metalness >= .5 && material.roughness <= .6);
}

// Returns a light for each lamp, because the emission of meshes lights nothing.
function makeLamp(lamp, radius) {
    const strength = Math.max(...lamp.emission);
    const colour = new THREE.Color(...lamp.emission.map(value => value / strength));
    const position = new THREE.Vector3(...lamp.position), direction = new THREE.Vector3(...lamp.direction ?? []);
    let light;
    if (direction.length() > 0) {
        light = new THREE.SpotLight(colour, strength * lamp.area, 0, Math.PI / 2, 0, 2);
        light.target.position.copy(position).add(direction.multiplyScalar(radius));
        light.shadow.focus = 150 / 180; // a shadow map of 150 degrees; light beyond has no shadow
    } else {
        light = new THREE.PointLight(colour, strength * lamp.area / 4, 0, 2);
    }
    light.position.copy(position);
    return light;
}

function setUpShadow(light, radius) {
    light.castShadow = true;
    light.shadow.mapSize.set(shadowEdge, shadowEdge);
    light.shadow.camera.near = 2e-3 * radius;
    light.shadow.camera.far = 4 * radius;
    light.shadow.normalBias = 1e-2 * radius;
    if (light.isDirectionalLight) {
        Object.assign(light.shadow.camera, { left: -radius, right: radius, top: radius, bottom: -radius });
        light.shadow.camera.near = -2 * radius;
    }
}

// Returns a material that shows the environment. Smooth metal looks it up directly. Rougher metal looks it up in filtered
// levels (PMREM), which take a software driver minutes.
function makeReflecting(material, environment) {
    if (material.roughness > .04) {
        const copy = material.clone();
        copy.envMap = environment;
        return copy;
    }
    return new THREE.MeshBasicMaterial({ color: material.color, map: material.map, envMap: environment, side: material.side });
}

// Gives each mirror a cube camera in its middle, and the mirror the cube camera's picture as its environment.
function addCaptures(scene, mirrors, face, radius) {
    return mirrors.map(mesh => {
        const target = new THREE.WebGLCubeRenderTarget(face, {
            type: THREE.HalfFloatType, generateMipmaps: true, minFilter: THREE.LinearMipmapLinearFilter });
        const camera = new THREE.CubeCamera(1e-3 * radius, 4 * radius, target);
        camera.position.copy(new THREE.Box3().setFromObject(mesh).getCenter(new THREE.Vector3()));
        scene.add(camera);
        mesh.material = (Array.isArray(mesh.material) ? mesh.material : [mesh.material])
            .map(material => makeReflecting(material, target.texture));
        if (mesh.material.length === 1) mesh.material = mesh.material[0];
        return { mesh, camera, target };
    });
}

function drawCaptures(renderer, scene, captures, rounds) {
    for (let round = 0; round < rounds; ++round)
        for (const { mesh, camera, target } of captures) {
            mesh.visible = false;
            camera.update(renderer, scene);
            mesh.visible = true;
            target.texture.needsPMREMUpdate = true;
        }
}

function makeCamera(facts, aspect, radius) {
    const eye = new THREE.Vector3(...facts.eye), target = new THREE.Vector3(...facts.target);
    const near = 1e-3 * radius, far = 4 * radius + eye.distanceTo(target), height = facts.orthographic_height;
    const camera = height
        ? new THREE.OrthographicCamera(-height * aspect / 2, height * aspect / 2, height / 2, -height / 2, near, far)
        : new THREE.PerspectiveCamera(facts.vertical_fov_degrees, aspect, near, far);
    camera.position.copy(eye);
    camera.up.set(...facts.up);
    camera.lookAt(target);
    camera.updateMatrixWorld();
    return camera;
}

function toBase64(bytes) {
    let text = '';
    for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
    return btoa(text);
}

// Returns the mean of side * side pictures that are shifted by parts of a pixel. Each pixel of one picture shows the point
// at its centre.
async function drawView(renderer, scene, camera, width, height, side) {
    const target = new THREE.WebGLRenderTarget(width, height, {
        type: THREE.FloatType, colorSpace: THREE.LinearSRGBColorSpace, samples: 0 });
    const sum = new Float32Array(4 * width * height), pixels = new Float32Array(4 * width * height);
    for (let i = 0; i < side * side; ++i) {
        const x = (i % side + .5) / side - .5, y = (Math.floor(i / side) + .5) / side - .5;
        camera.setViewOffset(width, height, x, y, width, height);
        renderer.setRenderTarget(target);
        renderer.render(scene, camera);
        renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
        for (let k = 0; k < sum.length; ++k) sum[k] += pixels[k] / (side * side);
    }
    renderer.setRenderTarget(null);
    target.dispose();
    const texture = new THREE.DataTexture(sum, width, height, THREE.RGBAFormat, THREE.FloatType);
    return new EXRExporter().parse(texture, { type: THREE.FloatType });
}

// Returns an EXR file, in base64, for each view of the scene.
window.drawScene = async ({ file, lamps, views, width, height, face, rounds, side }) => {
    const renderer = new THREE.WebGLRenderer({ antialias: false });
    renderer.toneMapping = THREE.NoToneMapping;
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = THREE.PCFShadowMap;
    const scene = new THREE.Scene();
    scene.background = new THREE.Color(0);
    scene.add((await new GLTFLoader().loadAsync(file)).scene);
    scene.updateMatrixWorld();
    const radius = new THREE.Box3().setFromObject(scene).getBoundingSphere(new THREE.Sphere()).radius;
    const mirrors = [], lights = [];
    scene.traverse(item => {
        if (item.isLight) lights.push(item);
        if (!item.isMesh) return;
        const glows = item.material.emissive?.getHex() && item.material.emissiveIntensity > 0;
        item.castShadow = item.receiveShadow = !glows;
        if (isMirror(item)) mirrors.push(item);
    });
    for (const lamp of lamps) {
        const light = makeLamp(lamp, radius);
        scene.add(light);
        if (light.target) scene.add(light.target);
        lights.push(light);
    }
    for (const light of lights) setUpShadow(light, radius);
    drawCaptures(renderer, scene, addCaptures(scene, mirrors, face, radius), rounds);
    const files = [];
    for (const view of views)
        files.push(toBase64(await drawView(renderer, scene, makeCamera(view.camera, width / height, radius), width, height, side)));
    renderer.dispose();
    return { files, renderer: renderer.getContext().getParameter(renderer.getContext().VERSION), three: THREE.REVISION };
};
window.ready = true;
