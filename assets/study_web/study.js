'use strict';
// A study in a browser: asks who takes part, shows the clips of the trials, asks the questions, keeps the
// answers in the browser and hands them out as a CSV file. Nothing is sent anywhere. The study is
// window.understudyStudy, from data.js. Texts of the study are only ever put in as text, never as markup.

const study = window.understudyStudy;
const kStore = 'understudy-study/';
const kColumns = ['participant', 'trial', 'question', 'answer', 'rt_ms', 'replays', 'shown_at', 'condition',
                  'other', 'motion', 'target', 'repetition', 'practice', 'design'];
const kBeat_ms = 1000, kAnswerOfATab_ms = 1600, kLoading_ms = 3000;

const element = id => document.getElementById(id);
const pause = ms => new Promise(done => setTimeout(done, ms));

/// A new element: properties by their names, attributes by names with a dash; texts and elements inside.
function make(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes('-') || name === 'role') made.setAttribute(name, value);
    else made[name] = value;
  }
  made.append(...children);
  return made;
}

const paragraph = (...content) => make('p', {}, ...content);
const box = (className, ...content) => make('div', {className}, ...content);

// ---- What the browser keeps. Without a store, as in some private windows, nothing fails: it is not kept.

function stored(key) {
  try {
    return localStorage.getItem(kStore + key);
  } catch {
    return null;
  }
}

function store(key, text) {
  try {
    localStorage.setItem(kStore + key, text);
    return true;
  } catch {
    return false;
  }
}

function unstore(key) {
  try {
    localStorage.removeItem(kStore + key);
  } catch {
    // there is no store
  }
}

/// Of ours, without the prefix.
function stored_keys() {
  try {
    return Object.keys(localStorage)
        .filter(key => key.startsWith(kStore))
        .map(key => key.slice(kStore.length));
  } catch {
    return [];
  }
}

function store_works() {
  const works = store('probe', '1');
  unstore('probe');
  return works;
}

function has_store() {
  try {
    return store_works() || localStorage.length > 0;
  } catch {
    return false;
  }
}

// ---- Pages: one at a time; what listened to the page before ends with it.

let page = new AbortController();

function show(...nodes) {
  page.abort();
  page = new AbortController();
  element('main').replaceChildren(...nodes);
  element('main').scrollTop = 0;
}

function on_key(act) {
  document.addEventListener('keydown', event => {
    if (!event.ctrlKey && !event.altKey && !event.metaKey && !event.isComposing) act(event);
  }, {signal: page.signal});
}

/// A page of text; `buttons` are their texts, the first is the one that Enter presses. Gives the text of the
/// one that was pressed; none: the page stays.
function told(title, content, buttons = []) {
  return new Promise(done => {
    const row = buttons.map((text, i) => make('button', {
      type: 'button', className: i === 0 ? 'main' : '', onclick: () => done(text),
    }, text));
    const card = make('section', {className: 'card', tabIndex: -1, 'aria-label': title},
                      make('h1', {}, title), ...content);
    if (row.length > 0) card.append(box('buttons', ...row));
    show(card);
    on_key(event => {
      const is_ours = event.key === 'Enter' && !event.repeat && !(event.target instanceof HTMLButtonElement);
      if (!is_ours || row.length === 0) return;
      event.preventDefault();
      row[0].click();
    });
    card.focus();
  });
}

function paragraphs(text) {
  return text.split('\n').filter(line => line.trim() !== '').map(line => paragraph(line));
}

function notice(text) {
  if (element('notice').textContent !== text) element('notice').textContent = text;
}

// ---- Answers: those of one participant, kept after every trial.

/// One answer a line, as `understudy study analyse` reads it; the first names the design that all belong to.
function csv_of(answers) {
  const cell = value => /[",\r\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value;
  const lines = answers.rows.map((row, i) => [...row, i === 0 ? answers.design : '']);
  return [kColumns, ...lines].map(line => line.map(value => cell(String(value))).join(',') + '\n').join('');
}

function download(answers) {
  const address = URL.createObjectURL(new Blob([csv_of(answers)], {type: 'text/csv'}));
  const link = make('a', {href: address, download: `${answers.participant}.csv`});
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(address), 60000);
}

let kept = true;

function keep(answers) {
  kept = store(`answers/${study.key}/${answers.participant}`, JSON.stringify(answers));
  if (kept)
    notice('');
  else if (has_store())
    notice('The browser\u2019s store is full: your answers are on this page only. Do not close or reload ' +
           'it, and download them before you leave.');
  else
    notice('This browser keeps nothing, perhaps because the window is private: you cannot go on after ' +
           'closing or reloading this page. Download your answers before you leave.');
  element('download').hidden = answers.rows.length === 0;
}

function warn_who_leaves(answers) {
  window.addEventListener('beforeunload', event => {
    if (!kept && answers.rows.length > 0) event.preventDefault();
  });
}

/// Null where there are none. Throws where they cannot be read.
function kept_answers(key) {
  const text = stored(key);
  if (text === null) return null;
  const answers = JSON.parse(text);
  const is_whole = Array.isArray(answers.rows) && Number.isInteger(answers.position);
  if (!is_whole || typeof answers.design !== 'string') throw new Error('no answers');
  return answers;
}

/// What is other than in the design that a digest tells of, in words.
function changes_since(design) {
  const before = JSON.parse(design), now = JSON.parse(study.design), changes = [];
  for (const [name, sum] of Object.entries(now))
    if (!(name in before)) changes.push(`${name} is new`);
    else if (before[name] !== sum) changes.push(name);
  for (const name of Object.keys(before)) if (!(name in now)) changes.push(`${name} is gone`);
  return changes.join(', ') || 'the order of conditions, motions, targets or questions';
}

const this_place = () => location.href.replace(/[?#].*$/, '');

/// The key of answers that the participant gave to this study when it was another one; undefined: there are
/// none.
function key_of_earlier_answers(name) {
  return stored_keys().find(key => {
    const [what, design, who] = key.split('/');
    if (what !== 'answers' || who !== name || design === study.key) return false;
    try {
      const answers = kept_answers(key);
      return answers.place === this_place() || answers.study === study.name;
    } catch {
      return false;
    }
  });
}

async function refuse_to_mix(key) {
  const earlier = kept_answers(key);
  const changes = changes_since(earlier.design);
  for (;;) {
    const pressed = await told('The study has changed', [
      paragraph(`${earlier.participant} has answered this study before it was changed (${changes}).`),
      paragraph('Answers from before and after do not belong into one file. ' +
                'Please tell the experimenter.'),
    ], ['Download the earlier answers', 'Delete them and begin again']);
    if (pressed.startsWith('Download')) {
      download(earlier);
      continue;
    }
    const sure = await told('Delete the earlier answers?', [
      paragraph(`${earlier.rows.length} answers of ${earlier.participant} will be gone from this browser.`),
    ], ['Keep them', 'Delete them']);
    if (sure === 'Delete them') break;
  }
  unstore(key);
}

/// Those that the browser has kept, else new ones.
async function answers_of(name) {
  const earlier = key_of_earlier_answers(name);
  if (earlier) await refuse_to_mix(earlier);
  try {
    const answers = kept_answers(`answers/${study.key}/${name}`);
    if (answers) return answers;
  } catch {
    await told('Answers that cannot be read', [
      paragraph(`What this browser has kept of ${name} is damaged. Please tell the experimenter.`),
    ], ['Begin again']);
  }
  return {participant: name, study: study.name, place: this_place(), design: study.design, agreed: false,
          position: 0, started: -1, starts: 0, rows: []};
}

// ---- One tab a participant: it writes its name into the store every second, and when another tab asks.

const kTab = Math.random().toString(36).slice(2);
let seat = null;

function holds_seat() {
  const holder = stored(seat);
  return holder === null || holder.startsWith(`${kTab} `);
}

function beat() {
  if (seat === null) return;
  if (holds_seat()) store(seat, `${kTab} ${performance.now()}`);
  else tell_of_other_tab();
}

function tell_of_other_tab() {
  seat = null;
  element('header').hidden = element('download').hidden = true;
  told('Already open', [
    paragraph('This participant\u2019s study is open in another tab or window of this browser.'),
    paragraph('Go on there and close this one, or close the other one first.'),
  ], ['Try again']).then(() => location.reload());
}

/// False when another tab is at it.
async function take_seat(name) {
  const key = `open/${study.key}/${name}`, before = stored(key);
  if (before !== null) {
    store(`ask/${study.key}/${name}`, `${kTab} ${performance.now()}`);
    await pause(kAnswerOfATab_ms);
    const now = stored(key);
    if (now !== null && now !== before) return false;
  }
  store(key, `${kTab} ${performance.now()}`);
  await pause(200);
  seat = key;
  if (!holds_seat()) return false;
  setInterval(beat, kBeat_ms);
  window.addEventListener('storage', event => {
    if (event.key === `${kStore}ask/${study.key}/${name}`) beat();
  });
  window.addEventListener('pagehide', () => {
    if (seat === null || !holds_seat()) return;
    unstore(seat);
    unstore(`ask/${study.key}/${name}`);
  });
  return true;
}

// ---- Who takes part.

const name_of = number => `P${String(number).padStart(2, '0')}`;

/// From 1; 0: the study has no such participant.
function number_of(text) {
  const number = Number(/^p?0*([1-9][0-9]*)$/i.exec(text.trim())?.[1] ?? 0);
  return number <= study.participants.length ? number : 0;
}

/// Of this tab, for a reload.
function remembered_name() {
  try {
    return sessionStorage.getItem(`${kStore}participant`) ?? '';
  } catch {
    return '';
  }
}

/// An empty name: the next one who sits there is asked.
function remember_name(name) {
  try {
    sessionStorage.setItem(`${kStore}participant`, name);
  } catch {
    // there is no store
  }
}

function refusal_of(name) {
  if (name.trim() === '') return 'Please enter the participant name that you were given.';
  const last = study.participants.length, there = last === 1 ? 'P01 only' : `P01 to ${name_of(last)}`;
  return `The study has no participant \u201c${name}\u201d: there are ${there}.`;
}

/// From the address, else from before a reload, else from whoever sits there.
function participant() {
  const given = new URLSearchParams(location.search).get('participant') ?? remembered_name();
  if (number_of(given)) return number_of(given);
  return new Promise(done => {
    const field = make('input', {type: 'text', id: 'participant', value: given, autocomplete: 'off',
                                 spellcheck: false, 'aria-describedby': 'problem'});
    const problem = make('p', {className: 'problem', id: 'problem', role: 'alert'});
    const enter = event => {
      event.preventDefault();
      if (number_of(field.value)) done(number_of(field.value));
      else problem.textContent = refusal_of(field.value);
    };
    show(make('form', {className: 'card', onsubmit: enter}, make('h1', {}, study.name),
              make('label', {className: 'name', htmlFor: 'participant'}, 'Participant name'), field, problem,
              box('buttons', make('button', {type: 'submit', className: 'main'}, 'Continue'))));
    if (given !== '') problem.textContent = refusal_of(given);
    field.focus();
  });
}

async function agreed() {
  while (study.consent.trim() !== '') {
    const pressed = await told('Before you begin', paragraphs(study.consent), ['I agree', 'I do not agree']);
    if (pressed === 'I agree') break;
    await told('Thank you', [paragraph('Nothing was recorded. You can close this page.')], ['Back']);
  }
}

// ---- Trials.

function trials_of(number) {
  const order = study.participants[number - 1], trials = [];
  for (let i = 0; i < order.length; i += 2) {
    const [id, condition, other, motion, target, repetition, practice, clip] = study.screens[order[i]];
    const factors = [study.conditions[condition], other < 0 ? '' : study.conditions[other],
                     study.motions[motion], study.targets[target], repetition, practice];
    trials.push({id, practice, factors, clip: study.clips[clip],
                 questions: study.asked[order[i + 1]].map(q => study.questions[q])});
  }
  const practised = trials.filter(trial => trial.practice).length, counted = trials.length - practised;
  trials.forEach((trial, i) => {
    trial.number = trial.practice ? i + 1 : i + 1 - practised;
    trial.of = trial.practice ? practised : counted;
    trial.place = `${trial.practice ? 'Practice' : 'Trial'} ${trial.number} of ${trial.of}`;
  });
  return trials;
}

function key_list() {
  const key = text => make('kbd', {}, text), line = (...content) => make('li', {}, ...content);
  const most = Math.min(9, Math.max(...study.questions.map(q => q.points ?? q.options.length)));
  return make('ul', {},
              line('Answer with the mouse, or with the keys ', key('1'), ' to ', key(String(most)),
                   ', for the question with the blue bar.'),
              line(key('Tab'), ' goes to the next question, the arrow keys change an answer.'),
              line(key('R'), ' plays the clip again, as often as you like.'),
              line(key('Enter'), ' continues when all questions are answered.'));
}

function instructed(trials) {
  const counted = trials.filter(trial => !trial.practice).length, practised = trials.length - counted;
  const before = practised > 0 ? `, and before them ${practised} for practice, which do not count` : '';
  return told('How it works', [
    paragraph(`You will see ${counted} clips${before}. This takes about ${study.minutes} minutes.`),
    paragraph('Each clip plays by itself, once to its end. Then the questions about it appear. There are ' +
              'no wrong opinions: answer as it seems to you.'),
    key_list(),
    paragraph('After a reload, or if you close this page, you go on where you stopped, in this browser.'),
  ], ['Begin']);
}

/// What stands between two trials.
async function between(before, trial, answers) {
  const every = study.break_every;
  if (before?.practice && !trial.practice)
    await told('The practice is over', [paragraph('From now on your answers count.')], ['Begin']);
  else if (every > 0 && !trial.practice && trial.number > 1 && (trial.number - 1) % every === 0)
    await told('Time for a break', [
      paragraph(`${trial.number - 1} of ${trial.of} trials are done. Go on when you are ready.`),
    ], ['Continue']);
}

/// In the order of their trials; each is loaded while the one before it is watched.
const clips = {
  next: null,
  loading(path) {
    const video = make('video', {src: path, muted: true, preload: 'auto', playsInline: true, tabIndex: -1,
                                 disablePictureInPicture: true, disableRemotePlayback: true,
                                 'aria-label': 'Clip'});
    video.load();
    return {path, video};
  },
  take(path) {
    const clip = this.next?.path === path && !this.next.video.error ? this.next : this.loading(path);
    this.next = null;
    return clip.video;
  },
  prepare(path) {
    if (path) this.next = this.loading(path);
  },
};

/// Plays from the start to the end; nobody can stop or skip it, and it waits while the page is hidden. Gives
/// what went wrong: 'failed', 'forbidden' (the browser wants a click first), '' nothing.
function played_once(video, loading) {
  return new Promise(done => {
    const life = new AbortController(), listen = {signal: life.signal};
    let moved = performance.now();
    const watch = setInterval(() => {
      if (document.hidden) moved = performance.now();
      loading.hidden = performance.now() - moved < kLoading_ms;
    }, 500);
    const finish = problem => {
      clearInterval(watch);
      loading.hidden = true;
      life.abort();
      done(problem);
    };
    const play = () => video.play().catch(error => {
      if (error.name === 'NotAllowedError') finish('forbidden');
      else if (error.name !== 'AbortError') finish('failed');
    });
    video.addEventListener('ended', () => finish(''), listen);
    video.addEventListener('error', () => finish('failed'), listen);
    video.addEventListener('timeupdate', () => { moved = performance.now(); }, listen);
    video.addEventListener('pause', () => { if (!video.ended && !document.hidden) play(); }, listen);
    document.addEventListener('visibilitychange', () => (document.hidden ? video.pause() : play()), listen);
    if (video.error) return finish('failed');
    if (video.currentTime > 0) video.currentTime = 0;
    if (!document.hidden) play();
  });
}

/// The place of a trial's clip.
class Stage {
  constructor(path) {
    this.path = path;
    this.video = clips.take(path);
    this.loading = box('loading', 'The clip is loading \u2026');
    this.loading.hidden = true;
    this.loading.setAttribute('role', 'status');
    this.node = box('stage', this.video, this.loading);
  }
  /// Browsers allow only so many players at a time.
  release() {
    this.video.removeAttribute('src');
    this.video.load();
  }
  /// Returns when the clip has been seen to its end.
  async play() {
    for (;;) {
      const problem = await played_once(this.video, this.loading);
      if (problem === '') return;
      if (problem === 'forbidden') {
        await this.wait_for_click('The clip is ready.', 'Play');
        continue;
      }
      await this.wait_for_click(`This clip cannot be played (${this.path}). Please tell the experimenter.`,
                                'Try again');
      this.release();
      const fresh = clips.loading(this.path).video;
      this.video.replaceWith(fresh);
      this.video = fresh;
    }
  }
  wait_for_click(text, button) {
    return new Promise(done => {
      const press = make('button', {type: 'button', className: 'main', onclick: () => {
        this.node.classList.remove('waits');
        card.remove();
        done();
      }}, button);
      const card = make('div', {className: 'card', role: 'alert'}, paragraph(text),
                        box('buttons', press));
      this.node.classList.add('waits');
      this.node.append(card);
      press.focus();
    });
  }
}

/// A question of a trial and its answer so far.
class Question {
  constructor(question, index, changed) {
    this.question = question;
    this.values = question.options ?? Array.from({length: question.points}, (_, i) => String(i + 1));
    this.answer = null;
    this.answered_ms = 0;
    this.radios = this.values.map((value, i) => make('input', {
      type: 'radio', name: `q${index}`, value: String(i), 'aria-label': this.spoken(i),
      onchange: () => changed(this, i),
    }));
    const labels = this.radios.map((radio, i) => this.label(radio, i));
    this.node = make('fieldset', {}, make('legend', {}, question.text),
                     question.options ? box('options', ...labels) : this.scale(labels));
  }
  spoken(i) {
    if (this.question.options) return this.values[i];
    const end = i === 0 ? this.question.low : i + 1 === this.values.length ? this.question.high : '';
    return end ? `${this.values[i]}, ${end}` : this.values[i];
  }
  label(radio, i) {
    if (!this.question.options) return make('label', {}, radio, this.values[i]);
    const key = i < 9 ? [make('kbd', {'aria-hidden': 'true'}, String(i + 1))] : [];
    return make('label', {}, radio, ...key, this.values[i]);
  }
  scale(labels) {
    const end = (className, text) => make('span', {className, 'aria-hidden': 'true'}, text);
    return box('scale', end('low', this.question.low), box('points', ...labels),
               end('high', this.question.high));
  }
  focus() {
    (this.radios.find(radio => radio.checked) ?? this.radios[0]).focus();
  }
}

/// The questions of a trial. Digits answer the one that is marked.
class Questions {
  constructor(trial) {
    const take = (one, value) => this.take(one, value);
    this.list = trial.questions.map((question, i) => new Question(question, i, take));
    this.replay = make('button', {type: 'button'}, 'Play again ', make('kbd', {'aria-hidden': 'true'}, 'R'));
    this.next = make('button', {type: 'button', className: 'main'}, 'Continue');
    this.hint = make('span', {className: 'hint', role: 'status'});
    const shown = this.list.map(one => one.node);
    if (shown.length === 0) shown.push(paragraph('No question this time.'));
    this.node = make('section', {className: 'card questions', 'aria-label': 'Questions', tabIndex: -1},
                     ...shown, box('buttons', this.replay, this.hint, this.next));
    this.node.hidden = true;
    for (const one of this.list) {
      one.node.addEventListener('focusin', () => this.mark(one));
      one.node.addEventListener('pointerdown', () => this.mark(one));
    }
    this.mark(this.list[0]);
    this.began_ms = this.shown_at = null;  // none yet; a replay does not begin anew
    this.refresh();
  }
  open() {
    this.node.hidden = false;
    (this.marked ?? this.node).focus();
    this.began_ms ??= performance.now();
    this.shown_at ??= new Date().toISOString();
  }
  close() {
    this.node.hidden = true;
  }
  mark(one) {
    this.marked?.node.classList.remove('marked');
    this.marked = one;
    one?.node.classList.add('marked');
  }
  unanswered() {
    return this.list.find(one => one.answer === null);
  }
  take(one, value) {
    one.answered_ms = performance.now() - this.began_ms;
    one.answer = one.values[value];
    this.refresh();
  }
  refresh() {
    const done = !this.unanswered();
    this.next.setAttribute('aria-disabled', String(!done));
    this.hint.textContent = done ? '' : 'Please answer every question.';
  }
  press_digit(digit) {
    const one = this.marked, radio = one?.radios[digit - 1];
    if (!radio) return;
    radio.checked = true;
    this.take(one, digit - 1);
    (this.unanswered() ?? one).focus();
  }
  press_enter(event) {
    if (event.target instanceof HTMLButtonElement && event.target !== this.next) return;
    event.preventDefault();
    if (!event.repeat) this.next.click();
  }
  /// 'replay' or 'next', when the participant wants it.
  decision() {
    return new Promise(done => {
      const act = event => {
        if (this.node.hidden) return;
        const digit = (/^([1-9])$/.exec(event.key) ?? /^(?:Digit|Numpad)([1-9])$/.exec(event.code))?.[1];
        if (digit) this.press_digit(Number(digit));
        else if (event.key.toLowerCase() === 'r' && !event.repeat) this.replay.click();
        else if (event.key === 'Enter') this.press_enter(event);
      };
      this.act = act;
      this.replay.onclick = () => done('replay');
      this.next.onclick = () => {
        const open = this.unanswered();
        if (open) open.focus();
        else done('next');
      };
    });
  }
}

/// Shows a trial and gives its answers as lines of the file.
async function run_trial(trial, next, answers) {
  const stage = new Stage(trial.clip), questions = new Questions(trial);
  show(stage.node, questions.node);
  on_key(event => questions.act?.(event));
  if (answers.started !== answers.position) answers.starts = 0;  // else it was reloaded during the trial
  answers.started = answers.position;
  clips.prepare(next?.clip);
  do {
    questions.close();
    stage.node.hidden = false;
    ++answers.starts;
    keep(answers);
    await stage.play();
    stage.node.hidden = true;
    questions.open();
  } while (await questions.decision() === 'replay');
  stage.release();
  return questions.list.map(
      one => [answers.participant, trial.id, one.question.name, one.answer, Math.round(one.answered_ms),
              answers.starts - 1, questions.shown_at, ...trial.factors]);
}

async function run_trials(trials, answers) {
  const resumed = answers.position;
  while (answers.position < trials.length) {
    const position = answers.position, trial = trials[position];
    if (position > resumed) await between(trials[position - 1], trial, answers);
    element('header').hidden = false;
    element('place').textContent = trial.place;
    element('place').classList.toggle('practice', trial.practice === 1);
    element('progress').value = (trial.number - 1) / trial.of;
    const rows = await run_trial(trial, trials[position + 1], answers);
    answers.rows.push(...rows);
    ++answers.position;
    keep(answers);
  }
  element('progress').value = 1;
}

async function finished(answers, is_new) {
  remember_name('');
  if (is_new) download(answers);
  element('place').textContent = 'The end';
  element('download').hidden = true;
  for (;;) {
    await told('Thank you: that was all', [
      paragraph(`Your answers are in the file ${answers.participant}.csv, in this browser\u2019s folder of ` +
                'downloads. Please hand it to the experimenter.'),
      paragraph('If there is no such file, download it again.'),
    ], ['Download answers']);
    download(answers);
  }
}

async function run() {
  document.title = study.name;
  const number = await participant(), name = name_of(number);
  remember_name(name);
  element('who').textContent = name;
  show();
  if (!await take_seat(name)) return tell_of_other_tab();
  const answers = await answers_of(name), trials = trials_of(number);
  element('download').onclick = () => download(answers);
  warn_who_leaves(answers);
  keep(answers);
  const is_new = answers.position < trials.length;
  if (!answers.agreed) {
    await agreed();
    await instructed(trials);
    answers.agreed = true;
    keep(answers);
  } else if (is_new) {
    const where = `You go on at: ${trials[answers.position].place}.`;
    const pressed = await told('Welcome back', [paragraph(where), key_list()],
                               ['Continue', `I am not ${name}`]);
    if (pressed !== 'Continue') {
      remember_name('');
      location.replace(this_place());
      return;
    }
  }
  await run_trials(trials, answers);
  await finished(answers, is_new);
}

/// Text on the study's background must be readable: dark on bright, bright on dark.
function take_colours(colour) {
  const [red, green, blue] = [1, 3, 5].map(i => parseInt(colour.slice(i, i + 2), 16));
  document.documentElement.style.setProperty('--background', colour);
  document.documentElement.classList.toggle('dark', 0.3 * red + 0.6 * green + 0.1 * blue < 128);
}

window.addEventListener('pageshow', event => {
  if (event.persisted) location.reload();  // the seat was left with the page
});
document.addEventListener('keydown', event => {
  if (event.repeat && event.key === 'Enter') event.preventDefault();  // a key that is held is pressed once
}, {capture: true});
document.addEventListener('contextmenu', event => event.preventDefault());
if (study) {
  take_colours(study.background);
  run();
} else {
  told('This study is not complete', [
    paragraph('The file data.js is missing beside index.html, or damaged. Please tell the experimenter.'),
  ]);
}
