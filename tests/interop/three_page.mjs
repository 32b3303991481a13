// Plays the clips that the server names and sends back where three.js puts every vertex, and a picture of each.
import * as THREE from 'three';
import {GLTFLoader} from '/three/examples/jsm/loaders/GLTFLoader.js';

const canvas = document.getElementById('view');

function send(path, body) {
  return fetch(path, {method: 'POST', body});
}

/// A thing that three.js puts vertices of. It skins no points: a skinned mesh that is not drawn borrows theirs.
async function posable(object, place, parser) {
  if (object.isMesh || object.geometry.attributes.skinIndex === undefined) return object;
  const node = parser.json.nodes.find(n => n.mesh === place.meshes && n.skin !== undefined);
  const mesh = new THREE.SkinnedMesh(object.geometry, new THREE.MeshBasicMaterial());
  mesh.morphTargetInfluences = object.morphTargetInfluences;
  mesh.normalizeSkinWeights();
  mesh.bind(await parser.getDependency('skin', node.skin), new THREE.Matrix4());
  mesh.visible = false;
  object.add(mesh);
  return mesh;
}

/// Everything that is drawn, in the order of the file's meshes and their primitives.
async function drawn_parts(gltf) {
  const found = [];
  gltf.scene.traverse(object => {
    if (object.isMesh || object.isPoints) found.push({object, place: gltf.parser.associations.get(object)});
  });
  found.sort((a, b) => a.place.meshes - b.place.meshes || a.place.primitives - b.place.primitives);
  return Promise.all(found.map(({object, place}) => posable(object, place, gltf.parser)));
}

/// World positions of all vertices as they are now, [V * 3].
function positions_of(parts) {
  const out = [], v = new THREE.Vector3();
  for (const object of parts) {
    for (let i = 0; i < object.geometry.attributes.position.count; ++i) {
      object.getVertexPosition(i, v);
      v.applyMatrix4(object.matrixWorld);
      out.push(v.x, v.y, v.z);
    }
  }
  return out;
}

class Player {
  constructor(gltf, clip) {
    this.scene = new THREE.Scene();
    this.scene.add(gltf.scene, new THREE.HemisphereLight(0xffffff, 0x404040, 3));
    this.mixer = new THREE.AnimationMixer(gltf.scene);
    this.action = this.mixer.clipAction(gltf.animations[clip]);
    this.action.setLoop(THREE.LoopOnce);
    this.action.clampWhenFinished = true;
  }
  at(seconds) {
    this.action.reset().play();  // one that came to its end stays there otherwise
    this.mixer.setTime(seconds);
    this.scene.updateMatrixWorld(true);
  }
}

/// The share of the picture that is not background, after drawing it.
function draw(renderer, scene, positions) {
  const box = new THREE.Box3().setFromArray(positions);
  const middle = box.getCenter(new THREE.Vector3()), size = box.getSize(new THREE.Vector3()).length();
  const camera = new THREE.PerspectiveCamera(30, 1, size / 100, size * 10);
  camera.position.copy(middle).add(new THREE.Vector3(0.4, 0.3, 1.7).multiplyScalar(size));
  camera.lookAt(middle);
  scene.traverse(object => { object.frustumCulled = false; });
  renderer.render(scene, camera);
  const gl = renderer.getContext(), {width, height} = canvas;
  const pixels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let drawn = 0;
  for (let i = 3; i < pixels.length; i += 4) drawn += pixels[i] > 0 ? 1 : 0;
  return drawn / (width * height);
}

function picture() {
  return new Promise(done => canvas.toBlob(done, 'image/png'));
}

async function play(job, renderer) {
  const gltf = await new GLTFLoader().loadAsync(`/file/${job.index}.glb`);
  const player = new Player(gltf, job.clip), parts = await drawn_parts(gltf);
  const all = [];
  let frame = [];
  for (const seconds of job.times) {
    player.at(seconds);
    frame = positions_of(parts);
    for (const value of frame) all.push(value);
  }
  const covered = draw(renderer, player.scene, frame);
  await send(`/picture/${job.index}`, await picture());
  await send(`/positions/${job.index}`, new Float32Array(all));
  return {clips: gltf.animations.map(a => a.name), parts: parts.length, vertices: frame.length / 3, covered};
}

async function main() {
  const renderer = new THREE.WebGLRenderer({canvas, antialias: true, alpha: true, preserveDrawingBuffer: true});
  for (const job of await (await fetch('/jobs')).json()) {
    let said;
    try {
      said = await play(job, renderer);
    } catch (error) {
      said = {failed: String(error)};
    }
    await send(`/said/${job.index}`, JSON.stringify(said));
  }
}

main().then(() => send('/done', ''), error => send('/done', String(error)));
