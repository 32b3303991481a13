// node three_play.mjs MODULES CHROMIUM JOBS: has a real browser play glTF files with three.js.
// JOBS is a JSON list of {"file", "clip", "times", "out"}. Writes OUT, the positions of all vertices at all times as
// float32 [T, V, 3], and OUT.png, the last of them drawn. Prints what the page said of each file as one JSON list.
import {spawn} from 'node:child_process';
import {mkdtemp, readFile, rm, writeFile} from 'node:fs/promises';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import {dirname, extname, join, normalize} from 'node:path';
import {fileURLToPath} from 'node:url';

const [modules, chromium, jobs_file] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const jobs = JSON.parse(await readFile(jobs_file)).map((job, index) => ({...job, index}));
const said = jobs.map(job => ({file: job.file, failed: 'the page never came to it'}));
const kPatience_ms = 240000;
const kTypes = {'.html': 'text/html', '.mjs': 'text/javascript', '.js': 'text/javascript'};

let finish;
const finished = new Promise(done => { finish = done; });

async function body_of(request) {
  const chunks = [];
  for await (const chunk of request) chunks.push(chunk);
  return Buffer.concat(chunks);
}

async function take(kind, index, body) {
  if (kind === 'positions') await writeFile(jobs[index].out, body);
  if (kind === 'picture') await writeFile(jobs[index].out + '.png', body);
  if (kind === 'said') said[index] = {file: jobs[index].file, ...JSON.parse(body)};
  if (kind === 'done') finish(body.toString());
}

function local_file(path) {
  if (path.startsWith('/file/')) return jobs[parseInt(path.slice('/file/'.length))].file;
  if (path.startsWith('/three/')) return join(modules, 'node_modules', normalize(path));
  return join(here, path === '/' ? 'three_page.html' : normalize(path));
}

const server = createServer(async (request, response) => {
  const [, kind, index] = request.url.split('/');
  try {
    if (request.method === 'POST') {
      await take(kind, parseInt(index), await body_of(request));
      response.end();
    } else if (kind === 'jobs') {
      response.end(JSON.stringify(jobs.map(({index, clip, times}) => ({index, clip, times}))));
    } else {
      const path = local_file(request.url), bytes = await readFile(path);
      response.setHeader('Content-Type', kTypes[extname(path)] ?? 'application/octet-stream');
      response.end(bytes);
    }
  } catch (error) {
    response.statusCode = 404;
    response.end(String(error));
  }
});

function start_browser(profile, port) {
  const browser = spawn(chromium, [
    '--headless', '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
    '--disable-component-update', '--disable-sync', '--disable-extensions', '--disable-dev-shm-usage',
    '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', `--user-data-dir=${profile}`,
    `http://127.0.0.1:${port}/`,
  ], {stdio: ['ignore', 'ignore', 'pipe'], detached: true});
  let complaints = '';
  browser.stderr.on('data', text => { complaints = (complaints + text).slice(-2000); });
  browser.on('error', error => finish(`${chromium}: ${error.message}`));
  browser.on('exit', code => finish(`the browser ended with ${code}: ${complaints}`));
  return browser;
}

const profile = await mkdtemp(join(tmpdir(), 'understudy-browser-'));
await new Promise(done => server.listen(0, '127.0.0.1', done));
const browser = start_browser(profile, server.address().port);
const clock = setTimeout(() => finish(`the page took longer than ${kPatience_ms / 1000} s`), kPatience_ms);
const problem = await finished;
clearTimeout(clock);
try {
  process.kill(-browser.pid, 'SIGKILL');
} catch {
  // it is gone already
}
server.closeAllConnections();
server.close();
await rm(profile, {recursive: true, force: true, maxRetries: 10, retryDelay: 100});
console.log(JSON.stringify(said));
if (problem) console.error(problem);
process.exitCode = problem ? 1 : 0;
