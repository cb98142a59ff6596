use std::sync::mpsc; use std::time::Duration; use std::collections::BTreeMap;
use campaign::{api::Api, choices::*, hostile::*};
fn main(){ let a: Vec<u64> = std::env::args().skip(1).map(|x| x.parse().unwrap()).collect();
 let api = Box::leak(Box::new(Api::linked())); let sp: &'static [u8] = specimen(api).leak(); let sp2 = sp;
 let mut n: BTreeMap<String,u32> = BTreeMap::new();
 for seed in a[0]..a[1] { let (t,r)=mpsc::channel(); let api: &'static Api = api;
  std::thread::spawn(move || { let h = changed(sp2, &mut Choices::new(&bytes(seed,32))); let _ = t.send(meet(api,&h)); });
  let k = match r.recv_timeout(Duration::from_secs(std::env::var("HUNT").map_or(1, |x| x.parse().unwrap()))) { Ok(Ok(o)) => format!("{o:?}"), Ok(Err(e)) => { println!("seed {seed}: {e}"); "BAD".into() }, Err(_) => { let h = changed(sp, &mut Choices::new(&bytes(seed,32)));
     let d: Vec<_> = h.iter().zip(sp).enumerate().filter(|(_,(x,y))| x!=y).map(|(i,(x,y))| (i,*y,*x)).collect(); println!("seed {seed}: TIMEOUT changed {d:?}"); "TIMEOUT".into() } };
  *n.entry(k).or_default() += 1; } println!("{n:?}"); std::process::exit(0) }
