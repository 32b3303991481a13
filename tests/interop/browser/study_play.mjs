// node study_play.mjs CHROMIUM SCENE WEB DOWNLOADS [...]: takes part in the study of a folder that
// `understudy study web` wrote. Prints what was seen and done as JSON.
import {existsSync, statSync} from 'node:fs';
import {cp, mkdir, readFile, rename, rm} from 'node:fs/promises';
import {createServer} from 'node:http';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';

import {Browser, pause} from './chromium.mjs';

const [chromium, scene, web, downloads, ...more] = process.argv.slice(2);
const kTypes = {html: 'text/html', css: 'text/css', js: 'text/javascript', mp4: 'video/mp4'};
const kPlaying = 'document.querySelector(".stage:not([hidden]) video") !== null';
const kAsking = 'document.querySelector(".questions:not([hidden])") !== null';
const kPlace = 'document.getElementById("place").textContent';
const kHeading = '(document.querySelector(".card:not([hidden]) h1")?.innerText ?? "")';

let asked_for;  // of the web server, where there is one

const address_in = folder => pathToFileURL(join(folder, 'index.html')).href;

async function downloaded(name) {
  const path = join(downloads, name);
  const is_there = () => existsSync(path) && statSync(path).size > 0;  // empty until all of it is written
  for (let i = 0; i < 500 && !is_there(); ++i) await pause(20);
  if (!is_there()) throw new Error(`${name} was not downloaded`);
}

async function enter(page) {
  await page.says('Before you begin');
  const consent = await page.evaluate(
      '[...document.querySelectorAll(".card p")].map(p => p.innerText).join("\\n\\n")');
  await page.click_button('I agree');
  await page.says('How it works');
  await page.press('Enter');
  return consent;
}

/// Goes on to the next trial over what stands between; its place, null at the end.
async function next_place(page, before, seen) {
  for (;;) {
    await page.until(`${kHeading} !== "" || (${kPlace} !== ${JSON.stringify(before)} && ${kPlaying})`);
    const heading = await page.evaluate(kHeading);
    if (heading === '') return page.evaluate(kPlace);
    if (heading.startsWith('Thank you')) return null;
    if (heading === 'Time for a break') ++seen.breaks;
    await page.press('Enter');
    await page.until(`${kHeading} !== ${JSON.stringify(heading)}`);
  }
}

/// What a question offers: its text and its answers.
function questions_on(page) {
  return page.evaluate(`[...document.querySelectorAll('.questions fieldset')].map(one => ({
    text: one.querySelector('legend').innerText,
    answers: [...one.querySelectorAll('input')].map((radio, i) =>
        one.querySelector('.options') ? radio.getAttribute('aria-label') : String(i + 1))}))`);
}

const radio = (question, answer) => `document.querySelectorAll('.questions fieldset')[${question}]
    .querySelectorAll('input')[${answer}]`;

/// From now on, `opened` is when the questions could first be answered.
function note_opening(page) {
  return page.evaluate(`window.opened = undefined; new MutationObserver(() => {
    if (${kAsking}) window.opened ??= performance.now();
  }).observe(document.getElementById('main'), {subtree: true, attributes: true, childList: true}); 0`);
}

const since_opening = page => page.evaluate('performance.now() - window.opened');

async function answer(page, index, by_keys) {
  const questions = await questions_on(page), given = [];
  for (let q = 0; q < questions.length; ++q) {
    const count = questions[q].answers.length;
    let chosen = (3 * index + q) % count;
    if (!by_keys && index % 3 === 0) await page.click(radio(q, (chosen + 1) % count));  // changes its mind
    const after_ms = await since_opening(page);
    if (!by_keys) {
      await page.click(`${radio(q, chosen)}.closest('label')`);
    } else if (q === 1 && index % 2 === 1) {
      await page.press('ArrowRight');  // from the first to the second
      chosen = 1;
    } else {
      await page.press(String(chosen + 1));
    }
    if (by_keys && q === 1 && index % 2 === 1 && q + 1 < questions.length) await page.press('Tab');
    if (by_keys && q === 0 && q + 1 < questions.length) await page.press('Enter');  // too early
    given.push({text: questions[q].text, answer: questions[q].answers[chosen], after_ms,
                before_ms: await since_opening(page)});
  }
  return given;
}

async function replay(page, by_keys) {
  if (by_keys) await page.press('r');
  else await page.click_button('Play again');
  await page.until(kPlaying);
  await page.until(kAsking);
}

async function take_trial(page, index, place, seen) {
  const by_keys = index % 2 === 0 || index % 4 === 1;
  const clip = await page.evaluate('document.querySelector("video").getAttribute("src")');
  const trial = {place, clip, replays: 0};
  if (seen.asked_for_before && !seen.asked_for_before.has(clip)) seen.late_clips.push(clip);
  if (await page.evaluate(kAsking)) throw new Error('questions are shown before the clip has ended');
  await note_opening(page);
  await page.press('Enter');  // skips nothing
  trial.shown_after = new Date().toISOString();
  await page.until(kAsking);
  seen.names_of_conditions_seen ||= await page.evaluate(
      'understudyStudy.conditions.some(name => document.body.textContent.includes(name))');
  if (index === seen.reloaded_in) {
    await answer(page, index, true);
    await page.reload();
    await page.says('Welcome back');
    seen.resumed_at = /You go on at: (.*)\./.exec(await page.text())[1];
    trial.shown_after = new Date().toISOString();
    await page.press('Enter');
    await page.until(kPlaying);
    await note_opening(page);
    await page.until(kAsking);
    ++trial.replays;
  }
  trial.shown_before = new Date().toISOString();
  if (index % 5 === 2 || index % 5 === 3) {
    await replay(page, index % 5 === 2);
    ++trial.replays;
  }
  trial.answers = await answer(page, index, by_keys);
  if (asked_for) seen.asked_for_before = new Set(asked_for);
  if (by_keys) await page.press('Enter');
  else await page.click_button('Continue');
  return trial;
}

/// All trials, or so many of them.
async function take_trials(page, seen, most = Infinity) {
  let place = '';
  while (seen.trials.length < most) {
    place = await next_place(page, place, seen);
    if (place === null) break;
    seen.trials.push(await take_trial(page, seen.trials.length, place, seen));
  }
  seen.places = seen.trials.map(trial => trial.place);
  seen.errors.push(...page.errors);
  return place;
}

const nothing_seen = () => ({
  errors: [], trials: [], breaks: 0, names_of_conditions_seen: false, reloaded_in: -1, late_clips: [],
});

async function second_tab_is_refused(browser, address) {
  const page = await browser.open(address);
  await page.says('open in another tab');
  await page.close();
  return true;
}

async function whole(browser, start, name) {
  const seen = nothing_seen(), address = `${start}?participant=${name}`;
  const page = await browser.open(address);
  seen.title = await page.evaluate('document.title');
  seen.consent = await enter(page);
  await take_trials(page, seen, 3);
  seen.second_tab = await second_tab_is_refused(browser, address);
  seen.reloaded_in = 7;
  await take_trials(page, seen);
  await downloaded(`${name}.csv`);
  seen.first_download = await readFile(join(downloads, `${name}.csv`), 'utf8');
  await rm(join(downloads, `${name}.csv`));
  await page.reload();
  await page.says('Thank you');
  await page.click_button('Download answers');
  await downloaded(`${name}.csv`);
  seen.second_download = await readFile(join(downloads, `${name}.csv`), 'utf8');
  return seen;
}

async function served(browser, start, name) {
  asked_for = new Set();
  const server = createServer(async (request, response) => {
    const path = new URL(request.url, 'http://x').pathname;
    asked_for.add(path.slice(1));
    try {
      const bytes = await readFile(join(web, path));
      response.setHeader('Content-Type', kTypes[path.split('.').pop()]);
      response.end(bytes);
    } catch {
      response.statusCode = 404;
      response.end();
    }
  });
  await new Promise(done => server.listen(0, '127.0.0.1', done));
  try {
    return await whole(browser, `http://127.0.0.1:${server.address().port}/index.html`, name);
  } finally {
    server.closeAllConnections();
    server.close();
  }
}

async function changed(browser, start, other_folder) {
  const seen = nothing_seen();
  let page = await browser.open(`${start}?participant=P01`);
  await enter(page);
  await take_trials(page, seen, 3);
  await next_place(page, seen.places[2], seen);
  seen.answered = seen.trials.flatMap(trial => trial.answers).length;
  await page.close();
  page = await browser.open(`${address_in(other_folder)}?participant=P01`);
  await page.says('The study has changed');
  seen.said = await page.text();
  await page.click_button('Download the earlier');
  await downloaded('P01.csv');
  await page.click_button('Delete them and');
  await page.says('will be gone');
  await page.click_button('Delete them');
  await enter(page);
  seen.after_deletion = await next_place(page, '', seen);
  await page.go(address_in(other_folder));  // without a name: this tab knows it
  await page.says('Welcome back');
  await page.click_button('I am not P01');
  await page.says('Participant name');
  seen.errors.push(...page.errors);
  return seen;
}

async function clip_that_is_missing(page, seen, clip) {
  const place = await next_place(page, seen.places.at(-1), seen);
  await page.says('cannot be played');
  seen.missing_clip = await page.text();
  await rename(join(web, 'away.mp4'), join(web, clip));
  await page.click_button('Try again');
  await page.until(kAsking);
  seen.played_after_all = true;
  seen.trials.push({place, answers: await answer(page, 1, true)});
  await page.press('Enter');
}

async function store_that_is_full(page, seen) {
  await page.evaluate(`(() => {
    let text = 'x'.repeat(1 << 20);
    for (let i = 0; text !== ''; ++i) {
      try {
        localStorage.setItem('filler' + i, text);
      } catch {
        text = text.slice(1 + text.length / 2);
      }
    }
  })()`);
  await take_trials(page, seen, 3);
  await page.until('document.getElementById("notice").textContent !== ""');
  seen.full_store = await page.text();
  seen.answered = seen.trials.flatMap(trial => trial.answers).length;
  await page.click_button('Download answers');
  await downloaded('P04.csv');
  await page.evaluate(`for (const key of Object.keys(localStorage))
    if (key.startsWith('filler')) localStorage.removeItem(key)`);
  await take_trials(page, seen, 4);
  await page.until('document.getElementById("notice").textContent === ""');
}

async function trouble(browser, start, clip) {
  const seen = nothing_seen();
  const page = await browser.open(`${start}?participant=${encodeURIComponent('P05<b>')}`);
  seen.unknown = await page.evaluate('document.querySelector(".problem").innerText');
  await page.evaluate('document.getElementById("participant").select()');
  await page.type('p4');
  await page.press('Enter');
  await enter(page);
  await take_trials(page, seen, 1);
  await clip_that_is_missing(page, seen, clip);
  await store_that_is_full(page, seen);

  const bare = await browser.open('about:blank');
  const source = `Object.defineProperty(window, 'localStorage', {
    get() { throw new DOMException('not here', 'SecurityError'); }})`;
  await bare.send('Page.addScriptToEvaluateOnNewDocument', {source});
  await bare.go(`${start}?participant=P03`);
  await enter(bare);
  await take_trials(bare, seen, 5);
  seen.no_store = await bare.text();

  const folder = join(downloads, 'incomplete');
  await mkdir(folder);
  for (const name of ['index.html', 'study.css', 'study.js']) await cp(join(web, name), join(folder, name));
  const incomplete = await browser.open(address_in(folder));
  await incomplete.says('not complete');
  seen.no_data = await incomplete.text();
  await rm(folder, {recursive: true});
  seen.errors = [...page.errors, ...bare.errors, ...incomplete.errors];
  return seen;
}

const browser = await Browser.start(chromium, downloads);
try {
  const seen = await {whole, served, changed, trouble}[scene](browser, address_in(web), ...more);
  console.log(JSON.stringify(seen));
} finally {
  await browser.close();
}
